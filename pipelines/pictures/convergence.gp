# The history of a run: measure, trust region, constraints. Arguments: folder of tables, picture.
data = ARG1 . '/history'
set terminal pngcairo size 1000,1000 font 'sans,11' background '#ffffff'
set output ARG2
set datafile separator "\t"
set datafile missing '-'
set datafile columnheaders
set multiplot layout 3,1 margins 0.09,0.91,0.07,0.97 spacing 0,0.05
set grid lc rgb '#dddddd'
set border 3
set tics nomirror
set xrange [-0.3:*]
set format x ''
set key top left opaque
set yrange [0:*]
set ylabel 'workspace measure'
plot data using 1:($2 == 1 ? $3 : NaN) with linespoints lw 2 pt 7 ps 1.2 lc rgb '#1f5fa8' title 'accepted', \
     data using 1:($2 == 0 ? $3 : NaN) with points pt 2 ps 1.4 lw 2 lc rgb '#c0392b' title 'rejected'
set ylabel 'actual / predicted gain'
set y2label 'trust radius, step [mm]'
set y2tics
set y2range [0:*]
set yrange [0:*]
set key top right opaque
plot data using 1:($1 > 0 ? $6 : NaN) with linespoints lw 2 pt 7 lc rgb '#1f5fa8' title 'ratio', \
     data using 1:7 axes x1y2 with steps lw 2 lc rgb '#e67e22' title 'radius (right)', \
     data using 1:10 axes x1y2 with points pt 6 ps 1.3 lw 2 lc rgb '#27ae60' title 'rms step (right)'
unset y2label
unset y2tics
set format x '%g'
set xlabel 'iteration'
set ylabel 'largest violation [%]'
set yrange [0:*]
plot data using 1:(100 * $9) with linespoints lw 2 pt 7 lc rgb '#8e44ad' title 'wall thickness', \
     data using 1:(100 * $8) with linespoints lw 2 pt 5 lc rgb '#16a085' title 'curvature'
