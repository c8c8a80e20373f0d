# The workspace of a two-chamber robot: image of the edges of the actuation square, before and after.
# Arguments: folder of tables, picture.
set terminal pngcairo size 1100,600 font 'sans,12' background '#ffffff'
set output ARG2
set size ratio -1
set grid lc rgb '#dddddd'
set border 3
set tics nomirror
set xlabel 'U_1 [mm]'
set ylabel 'U_3 [mm]'
set key outside bottom center horizontal reverse Left maxrows 2
set offsets graph 0.05, graph 0.05, graph 0.05, graph 0.05
before = ARG1 . '/workspace-before'
after = ARG1 . '/workspace-after'
plot after index 0 using 1:2 with filledcurves closed fs solid 1 fc rgb '#dce8f2' notitle, \
     after index 0 using 1:2 with lines lw 2.5 lc rgb '#1f5fa8' title 'last accepted design', \
     before index 0 using 1:2 with filledcurves closed fs solid 1 fc rgb '#f6d9bd' notitle, \
     before index 0 using 1:2 with lines lw 2.5 lc rgb '#b35f17' title 'first design', \
     after index 1 using 1:2 with points pt 7 ps 1.1 lc rgb '#1f5fa8' title 'computed (Gauss points and corners)', \
     after index 2 using 1:2 with points pt 6 ps 1.1 lc rgb '#1f5fa8' title 'by symmetry', \
     before index 1 using 1:2 with points pt 7 ps 0.9 lc rgb '#b35f17' notitle, \
     before index 2 using 1:2 with points pt 6 ps 0.9 lc rgb '#b35f17' notitle
