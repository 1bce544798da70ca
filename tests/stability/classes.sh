# SPDX-License-Identifier: BSD-2-Clause
# The classes of failures, to be read with `.`: one a line, in fields separated by |:
#   1 CLASS     its name, without commas: a column of stability.csv
#   2 OPTIONS   of adcgs-demo-scene, with @ for the strength; at strength 0 a --spoil, --noise or --aside with @ is left out;
#               after " // " those of adcgs-enc
#   3 STRENGTHS from mild to hard; the others are compared with the first
#   4 UNIT      of the strength
#   5 MEASURE   the affected figure: "moving", PSNR of dynamic regions; "all", PSNR; "fitted", PSNR after fitting of gains and
#               black levels; "worst", the lowest PSNR of dynamic regions of all views
#   6 FLOOR     STRENGTH:DB, asserted by check-long, or "none: REASON"
#   7 WHY       in one line, the reason why it breaks or does not
classes()
{
    cat <<'EOF'
speed|--scene race --motion @|0.15 0.5 1.5 4|x 0.07 widths a frame|moving|1.5:23|it is tracked up to 0.1 of its width a frame; faster, it moves away before it is matched, and leaves a ghost
turns|--scene turn3 --motion @|0.33 1 3|x 3 turns in 24 frames|moving|1:23.5|three turns in 24 frames are tracked as a rigid body; at nine turns it rotates by 0.4 of a turn a frame, and its patterns are mixed
sharp turns|--scene bounce --motion @|0.5 1.5 4|x 2 turns in 24 frames|moving|1.5:24|between frames the path is a smooth curve: if it turns between two frames, the box is displaced
occlusion|--scene wall --motion @|0.3 1 1.6|x half a width behind a wall|moving|1.6:20|it reappears unchanged; hidden parts are trained from few images, at its edge, where PSNR is lowest
collision|--scene collide --motion @|0.5 1 2|meetings|moving|2:19|where two objects touch, their patterns blur into each other
split|--scene split --motion @|0.3 1 2|x 1.1 apart|moving|2:22|each half moves in a straight line, and is tracked
split and merge|--scene merge --motion @|0.5 1 2|times|moving|2:20|where the halves touch, their patterns blur
appear and vanish|--scene blink@|5 2 1|frames|moving|2:19.5|lifetimes end where cameras see the background; test views are half way between frames, so that they show half of an object of one frame
thin rods|--scene rods@|4 2 1|x 0.6 pixels|moving|4:18|they are matched at their places, but their speed is known to two pixels a frame only: between frames they are displaced
moving texture|--scene slide --motion @|0.3 1 3|x 2.4 patches|moving|3:21|the texture is tracked as if it moved, and has to appear and vanish at the edges of the box
transparent|--scene glass@|30 60 90|% let through|moving|60:29|its faintest parts are taken as static: at 90 % nothing of the ball remains, at little loss
mirror|--scene mirror@|30 60 90|% reflected|moving|90:23|a reflection is at another place from each side, so that it blurs towards the edge
fire|--scene fire --motion @|0.1 0.3 1|x 23 sizes of its noise|moving|1:20|shapes of a single frame are not tracked; their mean is rendered, with little motion
sensor noise|--scene cross20 --noise @|0 6 16|levels of 255|all|16:27.5|noise is averaged; a third more anchors are grown for it, and a fifth more remain
exposure|--scene cross20 --spoil exposure=@|0 0.2 0.8|stops between cameras|fitted|0.2:28.5|gains of cameras are fitted in training; without them the mean camera differs from the original, hence fitted PSNR
white balance|--scene cross20 --spoil white=@|0 0.2 0.8|stops between cameras|fitted|0.8:26|as exposure, with a gain per channel
step of light|--scene cross20 --spoil step=@|0 0.2 0.8|stops, half of the time|fitted|none: fails from here on, all anchors have to change in one frame|gains belong to cameras, not to frames: all anchors have to darken at once, which costs sharpness, and the test images do not darken
step of light evened out|--scene cross20 --spoil step=@ // --set exposure_step_compensation=1|0 0.2 0.8|stops, half of the time|fitted|0.8:29.5|images after the step are trained as if there were no step
step of tint|--scene cross20 --spoil tint=@|0 0.2 0.8|stops between red and blue, half of the time|fitted|0.2:29.5|as a step of light: all anchors have to change in one frame, and the test images do not
step of tint evened out|--scene cross20 --spoil tint=@ // --set exposure_step_compensation=1|0 0.2 0.8|stops between red and blue, half of the time|fitted|0.8:29|as a step of light evened out
pose of cameras|--scene cross20 --spoil pose=@|0 0.3 1 3|pixels of 96|all|0.3:28|poses are not corrected: beyond a pixel of error the rays of a point do not meet, and views between the cameras are haze
pose of pictures|--scene cross20 --spoil shake=@|0 0.3 1 3|pixels of 96|all|0.3:25|no camera is fixed, so nothing is matched as with fixed cameras, and errors average to a blur
one wrong pose|--scene cross20 --spoil wrongpose=@|0 2 20|degrees, one of 12 cameras|all|20:26.5|eleven cameras outvote it, and floaters in front of it alone explain its images; the encoder names it
wrong axes|--scene cross20 --spoil axes=@|0 1 2 3|kind|all|none: fails from here on; before training the encoder reports the probable convention of the poses, and rejects mirrored ones|cameras that look away from the scene get their images from floaters in front of each of them: 22 dB in training
out of sync|--scene cross80 --spoil sync=@|0 0.5 2|frames|moving|0.5:22|an object is at as many places as there are clocks, so it is rendered over all of them
few views|--scene cross20 --cameras @|12 4 3 2|cameras|all|none: fails from 4 cameras on; the encoder warns of three and fewer|cameras 35 degrees and more apart are hardly matched (no point with two cameras), so each gets its own image from floaters in front of it
one moving camera|--scene film-@ --frames 90|cross20 cross80|scene|moving|cross80:20.5|it moves slowly, so its images are matched as those of a rig (7,700 points); dynamic regions are 3 dB below a rig's
from the side|--scene cross20 --aside @|0 0.05 0.15|turns beyond the arc of 0.39|all|none: fails from here on, no camera saw it|regions that no camera saw are missing, and splats are seen edge-on
before the first picture|--scene cross80 --spoil before=@|0 0.1 0.3|of the time|worst|none: fails from here on, no camera saw it|the first frame stays, frozen: moving objects are at other places, everything else is as good as before
no picture inside|--scene cross80 --spoil inside=@|0 0.2 0.5|of the time|worst|0.2:21|a short gap is bridged by linear motion; in a long one the object fades from one place to the other
after the last picture|--scene cross80 --spoil after=@|0 0.1 0.3|of the time|worst|none: fails beyond the observed time: no camera saw it, and the last frame stays frozen|the last frame stays, frozen
dropped pictures|--scene cross80 --spoil drop=@|0 0.3 0.8|of the images|moving|0.3:21|at 0.8 about one image of each frame remains, from which nothing can be matched, so dynamic content is lost
doubled where all cameras see all|--scene cross80 --cameras 4 --spoil twice=@|0 0.2 0.5|of the images|moving|0.2:21.3|duplicate images are detected and trained with the time that they show; matched points are still off
doubled pictures|--scene cross80 --spoil twice=@|0 0.2 0.5|of the images|moving|0.2:20|a duplicate image shows moving objects at the previous frame: they are rendered at both places
EOF
}
