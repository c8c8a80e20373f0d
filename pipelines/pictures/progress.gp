# Measures of several runs against iterations and against computing time. Arguments: folder of tables (one file per run,
# its name the title), picture, the names separated by blanks.
set terminal pngcairo size 1300,600 font 'sans,11' background '#ffffff'
set output ARG2
set datafile separator "\t"
set multiplot layout 1,2 margins 0.07,0.98,0.1,0.96 spacing 0.08,0
set grid lc rgb '#dddddd'
set border 3
set tics nomirror
set logscale y
set format y '%g'
set key bottom right opaque
set ylabel 'workspace measure'
set xlabel 'iteration'
plot for [i = 1:words(ARG3)] ARG1 . '/' . word(ARG3, i) using 1:3 with linespoints lw 2 pt 7 ps 0.7 title word(ARG3, i) noenhanced
set xlabel 'computing time, all stages [min]'
plot for [i = 1:words(ARG3)] ARG1 . '/' . word(ARG3, i) using 2:3 with linespoints lw 2 pt 7 ps 0.7 title word(ARG3, i) noenhanced
