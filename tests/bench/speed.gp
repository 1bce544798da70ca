# SPDX-License-Identifier: BSD-2-Clause
# A chart of the benchmark's table, without its smallest and middle sizes:
set terminal svg size 1100,1300 dynamic font 'sans-serif,12'
set output chart
set datafile separator ','
set style fill solid 0.7 noborder
set boxwidth 0.7
set key off
set grid xtics
set yrange [] reverse
set ytics nomirror
set offsets 0,0,0.4,0.4
set multiplot layout 2,1 margins 0.56,0.97,0.05,0.95 spacing 0,0.1

place(c) = column(4) > 0 ? sprintf(', %dx%d, %d', column(4), column(5), column(7)) : ''
name(c) = sprintf('%s: %s%s', strcol(1), strcol(2), place(0))

set title 'Percent of the machine's limit, one thread'
set xrange [0:100]
plot "< awk -F, 'NR > 1 && $14 > 0 && $8 == 1 && !/bf16/ && $4 !~ /^[28]00$/ && $7 !~ /^50*$/ && $4 * $7 != 4e7' ".table \
    using (50 * $14):0:(50 * $14):(0.35):ytic(name(0)) with boxxyerror

set title 'Rate of frames and iterations, a second'
set logscale x
set xrange [1:*]
plot "< awk -F, '$6 == 2000 && ($13 == \"frame\" || $13 == \"iteration\")' ".table \
    using ($12 / 2):0:($12 / 2):(0.35):ytic(sprintf('%s splats, %s', name(0), $8 > 1 ? sprintf('%d threads', $8) : '1 thread')) with boxxyerror
