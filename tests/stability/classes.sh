# SPDX-License-Identifier: BSD-2-Clause
# The failures that are looked for, to be read with `.`: a line each, in fields with | between:
#   1 CLASS     its name, without commas: a column of stability.csv
#   2 OPTIONS   of adcgs-demo-scene, with @ for the strength; where that is 0, a --spoil, --noise or --aside of it is left out;
#               behind " // " those of adcgs-enc
#   3 STRENGTHS from mild to hard; the first is what the others are measured against
#   4 UNIT      of the strength
#   5 MEASURE   what breaks: "moving", PSNR of what moves; "all", PSNR; "fitted", PSNR after gains and black levels are fitted;
#               "worst", the least PSNR of what moves, of all views
#   6 FLOOR     STRENGTH:DB, asserted by check-long, or "none: why not"
#   7 WHY       in one line, why it breaks or does not
classes()
{
    cat <<'EOF'
speed|--scene race --motion @|0.15 0.5 1.5 4|x 0.07 widths a moment|moving|1.5:23|up to 0.1 of the width a moment it is followed; faster, it is elsewhere before it is matched, and a ghost is left
turns|--scene turn3 --motion @|0.33 1 3|x 3 turns in 24 moments|moving|1:23.5|three turns in 24 moments are followed as a body; at nine it turns by 0.4 of a turn a moment, and its patterns are mixed
sharp turns|--scene bounce --motion @|0.5 1.5 4|x 2 turns in 24 moments|moving|1.5:24|between moments the way is a smooth curve: where it turns in between, the box is beside it
occlusion|--scene wall --motion @|0.3 1 1.6|x half a width behind a wall|moving|1.6:20|it comes back as it went; what is hidden is learnt from few pictures, at its edge, where dB are fewest
collision|--scene collide --motion @|0.5 1 2|meetings|moving|2:19|where two touch, their patterns blur into each other
split|--scene split --motion @|0.3 1 2|x 1.1 apart|moving|2:22|each half goes its way in a line, and is followed
split and merge|--scene merge --motion @|0.5 1 2|times|moving|2:20|where halves touch, their patterns blur
appear and vanish|--scene blink@|5 2 1|moments|moving|2:19.5|lives end where cameras show what is behind; test views are half way between moments, so that of what is there at one alone they show half
thin rods|--scene rods@|4 2 1|x 0.6 pixels|moving|4:18|they are matched where they are, but their speed is known to two pixels a moment only: between moments they are drawn beside
moving texture|--scene slide --motion @|0.3 1 3|x 2.4 patches|moving|3:21|it is followed as if it moved, and at the edges of the box it has to come and go
transparent|--scene glass@|30 60 90|% let through|moving|60:29|what shows least is taken as still: at 90 % nothing of the ball is left, and little is lost by it
mirror|--scene mirror@|30 60 90|% reflected|moving|90:23|a reflection is elsewhere from each side, so that it blurs towards the edge
fire|--scene fire --motion @|0.1 0.3 1|x 23 sizes of its noise|moving|1:20|shapes of a moment are not followed, their mean is drawn, moving a little
sensor noise|--scene cross20 --noise @|0 6 16|levels of 255|all|16:27.5|noise is averaged; a third more anchors are grown for it, a fifth more stay
exposure|--scene cross20 --spoil exposure=@|0 0.2 0.8|stops between cameras|fitted|0.2:28.5|gains of cameras are fitted in training; without them the mean camera is not the true one, hence fitted PSNR
white balance|--scene cross20 --spoil white=@|0 0.2 0.8|stops between cameras|fitted|0.8:26|as exposure, a gain per channel
step of light|--scene cross20 --spoil step=@|0 0.2 0.8|stops, half of the time|fitted|none: fails from here on, all has to change at one moment|gains are of cameras, not of moments: all anchors have to darken at once, which costs sharpness, and the truth of tests does not darken
step of light evened out|--scene cross20 --spoil step=@ // --set even_light=1|0 0.2 0.8|stops, half of the time|fitted|0.8:29.5|pictures behind it are learnt as if it had not been
step of tint|--scene cross20 --spoil tint=@|0 0.2 0.8|stops between red and blue, half of the time|fitted|0.2:29.5|as a step of light: all anchors have to change at one moment, and the truth of tests does not
step of tint evened out|--scene cross20 --spoil tint=@ // --set even_light=1|0 0.2 0.8|stops between red and blue, half of the time|fitted|0.8:29|as a step of light
pose of cameras|--scene cross20 --spoil pose=@|0 0.3 1 3|pixels of 96|all|0.3:28|poses are taken as they are: beyond a pixel rays of a point meet nowhere, and views between the cameras are haze
pose of pictures|--scene cross20 --spoil shake=@|0 0.3 1 3|pixels of 96|all|0.3:25|no camera stays, so nothing is matched in the way of cameras that do, and errors average to a blur
one wrong pose|--scene cross20 --spoil wrongpose=@|0 2 20|degrees, one of 12 cameras|all|20:26.5|eleven cameras outvote it, and clutter before it alone pays for its pictures; the encoder names it
wrong axes|--scene cross20 --spoil axes=@|0 1 2 3|kind|all|none: fails from here on; the encoder says before training how poses seem to be meant, and refuses what is mirrored|cameras that look away from the scene are each given their pictures by clutter before them: 22 dB in training
out of sync|--scene cross80 --spoil sync=@|0 0.5 2|moments|moving|0.5:22|a thing is at as many places as there are clocks, so it is drawn over all of them
few views|--scene cross20 --cameras @|12 4 3 2|cameras|all|none: fails from 4 cameras on; the encoder says so of three and fewer|cameras 35 degrees and more apart are hardly matched (no point at two), so each is given a picture of its own before it
one moving camera|--scene film-@ --moments 90|cross20 cross80|scene|moving|cross80:20.5|it moves slowly, so its pictures are matched as a rig's (7,700 points); what moves is 3 dB below that of a rig
from the side|--scene cross20 --aside @|0 0.05 0.15|turns beside the arc of 0.39|all|none: fails from here on, nobody saw it|what no camera saw is not there, and splats seen from their edge are
before the first picture|--scene cross80 --spoil before=@|0 0.1 0.3|of the time|worst|none: fails from here on, nobody saw it|the first moment stays, frozen: what moves is elsewhere, all else is as good as ever
no picture inside|--scene cross80 --spoil inside=@|0 0.2 0.5|of the time|worst|0.2:21|a short gap is gone through in a line; in a long one it fades from one place to the other
after the last picture|--scene cross80 --spoil after=@|0 0.1 0.3|of the time|worst|none: beyond what was seen it fails: nobody saw it, and it stays frozen|the last moment stays, frozen
dropped pictures|--scene cross80 --spoil drop=@|0 0.3 0.8|of the pictures|moving|0.3:21|at 0.8 about one picture of each moment is left, from which nothing can be matched, so what moves is lost
doubled where all cameras see all|--scene cross80 --cameras 4 --spoil twice=@|0 0.2 0.5|of the pictures|moving|0.2:21.3|such pictures are told from others and learnt as of the time that they show; what is matched is still off
doubled pictures|--scene cross80 --spoil twice=@|0 0.2 0.5|of the pictures|moving|0.2:20|a picture that comes twice shows what moves where it was a moment before: it is drawn over both places
EOF
}
