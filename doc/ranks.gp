# SPDX-License-Identifier: BSD-2-Clause
# Chart of doc/ranks.sh: gnuplot -e "folder='ranks'" doc/ranks.gp
set terminal svg size 700,450 dynamic font 'sans-serif,12'
set datafile separator ','
set grid
set key noenhanced bottom right
set output folder.'/ranks.svg'
set title 'A scene in segments, and views of one segment, trained by many ranks'
set xlabel 'ranks'
set ylabel 'speed-up over one rank'
set logscale xy 2
set format y '%.3g'
curves = system("awk -F, 'NR > 1 && !seen[$1]++ { print $1 }' ".folder.'/ranks.csv')
one(name) = real(system("awk -F, '$1 == \"".name."\" && $2 == 1 { print $3 }' ".folder.'/ranks.csv'))
plot for [name in curves] '< grep "^'.name.'," '.folder.'/ranks.csv' using 2:(one(name) / $3) with linespoints title name
