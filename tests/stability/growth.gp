# SPDX-License-Identifier: BSD-2-Clause
# Anchors and bytes over training, a line for each strength: gnuplot -e "data='FILE'; chart='FILE.svg'; n=N" growth.gp. Each block
# of data has its strength as a heading, and columns iteration, anchors, kilobytes.
set terminal svg size 330,250 dynamic font 'sans-serif,10'
set output chart
set grid
set key bottom right samplen 1.5 noenhanced
set yrange [0:*]
set multiplot layout 2,1
set lmargin 9
set format x ''
set ylabel 'anchors'
plot for [i=0:n-1] data index i using 1:2 with lines title columnheader(1)
set format x '%g'
set xlabel 'iteration'
set ylabel 'kB'
unset key
plot for [i=0:n-1] data index i using 1:3 with lines notitle
unset multiplot
