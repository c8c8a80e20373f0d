# CPU time by size of the problem, fesolve and CalculiX on the same meshes. Arguments: table, picture.
set terminal pngcairo size 1000,700 font 'sans,11' background '#ffffff'
set output ARG2
set datafile separator "\t"
set datafile columnheaders
set grid lc rgb '#dddddd'
set border 3
set tics nomirror
set logscale xy
set key top left opaque
set xlabel 'unknowns'
set ylabel 'CPU time from zero to the full pressure, one thread [s]'
of(name, y) = strcol(1) eq name ? column(y) : NaN
set datafile missing NaN
plot ARG1 using 2:(of('CalculiX C3D10', 5)) with linespoints lw 2 pt 7 ps 1.2 lc rgb '#c0392b' title 'CalculiX C3D10, to the same digits', \
     ARG1 using 2:(of('CalculiX C3D10', 6)) with linespoints lw 2 pt 6 ps 1.2 lc rgb '#e67e22' title 'CalculiX C3D10, at its default stop', \
     ARG1 using 2:(of('fesolve tet10', 5)) with linespoints lw 2 pt 7 ps 1.2 lc rgb '#1f5fa8' title 'fesolve, tet10: the same element', \
     ARG1 using 2:(of('fesolve tet10-blend', 5)) with linespoints lw 2 pt 5 ps 1.2 lc rgb '#16a085' title 'fesolve, tet10-blend: the default'
