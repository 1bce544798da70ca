# SPDX-License-Identifier: BSD-2-Clause
# The failures that are looked for, to be read with `.`: a line each, in fields with | between:
#   1 CLASS     its name
#   2 OPTIONS   of adcgs-demo-scene, with @ for the strength; where that is 0, a --spoil, --noise or --aside of it is left out
#   3 STRENGTHS from mild to hard; the first is what the others are measured against
#   4 UNIT      of the strength
#   5 MEASURE   what breaks: "moving", PSNR of what moves; "all", PSNR; "worst", the PSNR of the worst view
#   6 FLOOR     STRENGTH:DB, asserted by check-long, or "none: why not"
#   7 WHY       in one line, why it breaks or does not
classes()
{
    cat <<'EOF'
speed|--scene race --motion @|0.15 0.5 1.5 4|x 0.07 widths a moment|moving|none|?
turns|--scene turn3 --motion @|0.33 1 3|x 3 turns in 24 moments|moving|none|?
sharp turns|--scene bounce --motion @|0.5 1.5 4|x 2 turns in 24 moments|moving|none|?
occlusion|--scene wall --motion @|0.3 1 1.6|x half a width behind a wall|moving|none|?
collision|--scene collide --motion @|0.5 1 2|meetings|moving|none|?
split|--scene split --motion @|0.3 1 2|x 1.1 apart|moving|none|?
split and merge|--scene merge --motion @|0.5 1 2|times|moving|none|?
appear and vanish|--scene blink@|5 2 1|moments|moving|none|?
thin rods|--scene rods@|4 2 1|x 0.6 pixels|moving|none|?
moving texture|--scene slide --motion @|0.3 1 3|x 2.4 patches|moving|none|?
transparent|--scene glass@|30 60 90|% let through|moving|none|?
mirror|--scene mirror@|30 60 90|% reflected|moving|none|?
fire|--scene fire --motion @|0.1 0.3 1|x 23 sizes of its noise|moving|none|?
sensor noise|--scene cross20 --noise @|0 6 16|levels of 255|all|none|?
exposure|--scene cross20 --spoil exposure=@|0 0.2 0.8|stops between cameras|all|none|?
white balance|--scene cross20 --spoil white=@|0 0.2 0.8|stops between cameras|all|none|?
step of light|--scene cross20 --spoil step=@|0 0.2 0.8|stops, half of the time|all|none|?
pose of cameras|--scene cross20 --spoil pose=@|0 0.3 1 3|pixels of 96|all|none|?
pose of pictures|--scene cross20 --spoil shake=@|0 0.3 1 3|pixels of 96|all|none|?
one wrong pose|--scene cross20 --spoil wrongpose=@|0 2 20|degrees, one of 12 cameras|all|none|?
wrong axes|--scene cross20 --spoil axes=@|0 1 2 3|kind|all|none|?
out of sync|--scene cross80 --spoil sync=@|0 0.5 2|moments|moving|none|?
few views|--scene cross20 --cameras @|12 4 3 2|cameras|all|none|?
one moving camera|--scene film-@ --moments 90|cross20 cross80|scene|moving|none|?
from the side|--scene cross20 --aside @|0 0.05 0.15|turns beside the arc of 0.39|all|none|?
before the first picture|--scene cross80 --spoil before=@|0 0.1 0.3|of the time|worst|none|?
no picture inside|--scene cross80 --spoil inside=@|0 0.2 0.5|of the time|worst|none|?
after the last picture|--scene cross80 --spoil after=@|0 0.1 0.3|of the time|worst|none|?
dropped pictures|--scene cross80 --spoil drop=@|0 0.3 0.8|of the pictures|moving|none|?
doubled pictures|--scene cross80 --spoil twice=@|0 0.2 0.5|of the pictures|moving|none|?
EOF
}
