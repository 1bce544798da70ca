# SPDX-License-Identifier: BSD-2-Clause
# Chart of a class of the failure suite: gnuplot -e "data='FILE'; chart='FILE.svg'; unit='TEXT'" charts.gp; the columns are those
# of summary.
set terminal svg size 330,210 dynamic font 'sans-serif,10'
set output chart
set datafile missing '-'
set grid
set key bottom left samplen 1.5
set xlabel unit noenhanced
set ylabel 'dB'
set offsets 0.2, 0.2, 1, 1
plot data using 0:4:xtic(1) with linespoints title 'all', '' using 0:5 with linespoints title 'moving regions', \
    '' using 0:6 with linespoints title 'worst view of them'
