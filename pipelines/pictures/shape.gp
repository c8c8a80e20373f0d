# First design and last accepted one: lit surfaces, the body half transparent, and the section y = 0.
# Arguments: folder of tables, picture.
set terminal pngcairo size 1600,800 font 'sans,12' background '#ffffff'
set output ARG2
set multiplot
unset key
unset colorbox
unset border
unset tics
stats ARG1 . '/section-before' using 1:2 nooutput name 'A'
stats ARG1 . '/section-after' using 1:2 nooutput name 'B'
reach = 1.05 * (A_max_x > B_max_x ? A_max_x : B_max_x)
height = A_max_y > B_max_y ? A_max_y : B_max_y
set xyplane at 0
set view 66,28,2.0,1
set view equal xyz
set pm3d depthorder
air(light) = hsv2rgb(0.075, 0.72, 0.68 + 0.3 * light)
body(light) = hsv2rgb(0.57, 0.35, 0.68 + 0.3 * light) + 0xd8000000
left = 0
do for [which in 'before after'] {
    set label 1 (which eq 'before' ? 'first design' : 'last accepted design') at screen left + 0.25,0.95 center font ',16'
    set lmargin at screen left
    set rmargin at screen left + 0.25
    set tmargin at screen 0.93
    set bmargin at screen 0.02
    set xrange [-reach:reach]
    set yrange [-reach:reach]
    set zrange [0:height]
    table = ARG1 . '/surface-' . which
    splot table using 1:2:3:($6 > 0 ? air($5) : body($5)) with pm3d fc rgb variable
    unset label 1
    set lmargin at screen left + 0.26
    set rmargin at screen left + 0.49
    set size ratio -1
    set xrange [-reach:reach]
    set yrange [-2:height + 2]
    table = ARG1 . '/section-' . which
    plot table index 0 using 1:2 with filledcurves closed fs solid 1 fc rgb '#a9c4dc', \
         table index 0 using 1:2 with lines lw 1.5 lc rgb '#2c5475', \
         table index 1:99 using 1:2 with filledcurves closed fs solid 1 fc rgb '#ffffff', \
         table index 1:99 using 1:2 with lines lw 1.5 lc rgb '#b35f17'
    left = 0.5
}
