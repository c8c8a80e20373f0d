# The boundary of a dense workspace. Arguments: table of `pmplot boundary`, measure, picture, names of the three coordinates.
set terminal pngcairo size 900,800 font 'sans,12' background '#ffffff'
set output ARG3
unset key
set grid lc rgb '#dddddd'
set palette defined (0 '#2b4c7e', 0.5 '#8fb8de', 1 '#f2a65a')
set cblabel 'pointing angle [degrees]'
set title 'dense workspace, ' . ARG2
set xlabel ARG4 noenhanced
set ylabel ARG5 noenhanced
set zlabel ARG6 noenhanced
if (ARG2 eq '2T') {
    set size ratio -1
    plot ARG1 using 1:2:4 with lines lw 3 lc palette
} else {
    set view equal xyz
    set view 65,35
    set xyplane relative 0
    if (ARG2 eq '2R') {
        set parametric
        set urange [0:2 * pi]
        set vrange [0:pi / 2]
        set isosamples 25, 9
        splot cos(u) * sin(v), sin(u) * sin(v), cos(v) with lines lw 0.5 lc rgb '#bbbbbb', \
              ARG1 using 1:2:3:4 with lines lw 4 lc palette
    } else {
        if (ARG2 eq '1R2T') { set view noequal }
        stats ARG1 using 3 name 'Z' nooutput
        if (ARG2 ne '1R2T') { set ztics (sprintf('%.3g', Z_min) Z_min, sprintf('%.3g', Z_max) Z_max) }
        set pm3d depthorder border lc rgb '#60404040' lw 0.3
        splot ARG1 using 1:2:3:4 with pm3d
    }
}
