# The end-effector along a path of pressures. Arguments: table of `pmplot path`, number of chambers, picture.
n = int(ARG2)
set terminal pngcairo size 1000,900 font 'sans,11' background '#ffffff'
set output ARG3
set multiplot layout 3,1 margins 0.09,0.97,0.07,0.97 spacing 0,0.05
set grid lc rgb '#dddddd'
set border 3
set tics nomirror
set key top left opaque
set format x ''
set ylabel 'pressure / mu'
plot for [r=1:n] ARG1 using 0:r with linespoints lw 2 pt 7 ps 0.7 title sprintf('chamber %d', r)
set ylabel 'translation [mm]'
plot for [i=1:3] ARG1 using 0:n+i with linespoints lw 2 pt 7 ps 0.7 title sprintf('U_%d', i)
set format x '%g'
set xlabel 'point'
set ylabel 'rotation [degrees]'
plot for [i=4:6] ARG1 using 0:(column(n + i) * 180 / pi) with linespoints lw 2 pt 7 ps 0.7 title sprintf('U_%d', i)
