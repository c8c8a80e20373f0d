# Error of the pose of two bellows bodies by the time of a factorisation. Arguments: table, picture.
set terminal pngcairo size 1300,620 font 'sans,11' background '#ffffff'
set output ARG2
set datafile separator "\t"
set datafile columnheaders
set datafile missing NaN
set grid lc rgb '#dddddd'
set border 3
set tics nomirror
set logscale xy
set xrange [0.0005:10]
set yrange [0.1:100]
set format y '%g %%'
set xlabel 'CPU time of a factorisation, one thread [s]'
set multiplot layout 1,2
is(b, e, k) = strcol('body') eq b && strcol('element') eq e && strcol('kind') eq k && column('kappa') == 100 && strcol('law') eq 'neo-hookean'
error(b, e, k) = is(b, e, k) ? column('e_pose') : NaN
do for [b in 'q h'] {
    set title b eq 'q' ? 'symmetric bellows: elongation' : 'bellows that bends: tip translation'
    set ylabel 'error of the tip translation'
    set key top right opaque
    plot ARG1 using 'factor_s':(error(b, 'tet4', 'linear')) with linespoints lw 2 pt 8 ps 1.3 lc rgb '#7f8c8d' title 'tet4', \
         ARG1 using 'factor_s':(error(b, 'tet10', 'straight')) with linespoints lw 2 dt 2 pt 6 ps 1.3 lc rgb '#c0392b' title 'tet10, straight edges', \
         ARG1 using 'factor_s':(error(b, 'tet10', 'curved')) with linespoints lw 2 pt 7 ps 1.3 lc rgb '#c0392b' title 'tet10', \
         ARG1 using 'factor_s':(error(b, 'tet10-blend', 'straight')) with linespoints lw 2 dt 2 pt 4 ps 1.3 lc rgb '#16a085' title 'tet10-blend, straight edges', \
         ARG1 using 'factor_s':(error(b, 'tet10-mean', 'curved')) with linespoints lw 2 pt 13 ps 1.3 lc rgb '#e67e22' title 'tet10-mean', \
         ARG1 using 'factor_s':(error(b, 'tet15', 'curved')) with linespoints lw 2 pt 9 ps 1.3 lc rgb '#1f5fa8' title 'tet15', \
         ARG1 using 'factor_s':(error(b, 'tet10-blend', 'curved')) with linespoints lw 3 pt 5 ps 1.3 lc rgb '#16a085' title 'tet10-blend, the default'
}
