# Volume and largest distance from the first form over repeated reconstructions. Arguments: folder of the tables, picture.
set terminal pngcairo size 1100,460 font 'sans,11' background '#ffffff'
set output ARG2
set datafile separator "\t"
set datafile columnheaders
set grid lc rgb '#dddddd'
set border 3
set tics nomirror
set xlabel 'reconstructions'
set multiplot layout 1,2
set ylabel 'volume, part of the first'
set key bottom left
plot for [m in 'remesh conformal paper'] ARG1.'/'.m.'.tsv' using 'call':'volume' with linespoints lw 2 pt 7 ps 0.5 \
    lc rgb (m eq 'paper' ? '#c0392b' : m eq 'remesh' ? '#16a085' : '#1f5fa8') title m
set ylabel 'largest distance from the first form [mm]'
set key top left
set logscale y
plot for [m in 'remesh conformal paper'] ARG1.'/'.m.'.tsv' using 'call':(column('call') > 0 ? column('max') : NaN) with linespoints lw 2 pt 7 ps 0.5 \
    lc rgb (m eq 'paper' ? '#c0392b' : m eq 'remesh' ? '#16a085' : '#1f5fa8') title m
