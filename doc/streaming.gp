# SPDX-License-Identifier: BSD-2-Clause
# Charts of doc/streaming.sh: gnuplot -e "folder='streaming'" doc/streaming.gp
set terminal svg size 700,450 dynamic font 'sans-serif,12'
set datafile separator ','
set datafile missing '-'
set grid
set key bottom right

set output folder.'/prefixes.svg'
set title 'Quality of the beginning of a stream'
set xlabel 'percent of the bytes'
set ylabel 'PSNR, dB'
set xrange [0:100]
scenes = system("awk -F, 'NR > 1 && !seen[$1]++ { print $1 }' ".folder.'/prefixes.csv')
plot for [name in scenes] '< grep "^'.name.'," '.folder.'/prefixes.csv' using 2:4 with linespoints title name

set output folder.'/segments.svg'
set title 'A clip of ten seconds in segments'
set xlabel 'segments'
set ylabel 'bytes'
set xrange [0:*]
set yrange [0:*]
set key top left
plot for [kind in 'keys predicted whole'] '< grep "^'.kind.'," '.folder.'/segments.csv' using 2:3 with linespoints title kind
