# Errors of the shape derivatives of the thick sphere by mesh size. Arguments: table, picture.
set terminal pngcairo size 1300,560 font 'sans,11' background '#ffffff'
set output ARG2
set datafile separator "\t"
set datafile columnheaders
set datafile missing NaN
set grid lc rgb '#dddddd'
set border 3
set tics nomirror
set logscale xy
set xrange [2.5:15]
set xtics (3, 4, 6, 8, 12)
set yrange [0.001:100]
set format y '%g %%'
set xlabel 'parts a side of the octant'
set multiplot layout 1,2
error(f, k, c) = strcol('form') eq f && column('kappa') == k ? 100 * abs(column(c)) : NaN
do for [c in 'e_dA e_dpdA'] {
    set title (c eq 'e_dA') ? 'derivative of the outer displacement by A' : 'derivative of dub/dp by A'
    set ylabel 'error'
    set key top right opaque
    plot ARG1 using 'parts':(error('boundary', 10, c)) with linespoints lw 2 pt 6 ps 1.3 lc rgb '#e67e22' title 'boundary form, kappa = 10 mu', \
         ARG1 using 'parts':(error('boundary', 100, c)) with linespoints lw 2 pt 7 ps 1.3 lc rgb '#c0392b' title 'boundary form, 100 mu', \
         ARG1 using 'parts':(error('boundary', 1000, c)) with linespoints lw 2 pt 9 ps 1.3 lc rgb '#7f1d1d' title 'boundary form, 1000 mu', \
         ARG1 using 'parts':(error('domain', 10, c)) with linespoints lw 2 pt 4 ps 1.3 lc rgb '#5dade2' title 'domain form, kappa = 10 mu', \
         ARG1 using 'parts':(error('domain', 100, c)) with linespoints lw 2 pt 5 ps 1.3 lc rgb '#16a085' title 'domain form, 100 mu', \
         ARG1 using 'parts':(error('domain', 1000, c)) with linespoints lw 2 pt 13 ps 1.3 lc rgb '#1f5fa8' title 'domain form, 1000 mu'
}
