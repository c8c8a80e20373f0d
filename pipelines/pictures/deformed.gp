# The last accepted design at full pressure: one chamber, both chambers, coloured by displacement.
# Arguments: folder of tables, picture.
set terminal pngcairo size 1300,850 font 'sans,12' background '#ffffff'
set output ARG2
one = ARG1 . '/deformed-one'
both = ARG1 . '/deformed-all'
stats one using 1:3 nooutput name 'A'
stats one using 4:2 nooutput name 'U'
stats both using 1:3 nooutput name 'B'
stats both using 4:2 nooutput name 'V'
larger(a, b) = a > b ? a : b
most = larger(U_max_x, V_max_x)
# Blue to red by displacement, brightness by light; the palette of the scale is the same curve.
hue(u) = 0.62 * (1 - u / most)
colour(u, light) = hsv2rgb(hue(u), 0.62, 0.62 + 0.36 * light)
set palette model HSV functions 0.62 * (1 - gray), 0.62, 0.9
set cbrange [0:most]
set multiplot
unset key
unset border
unset tics
set xyplane at 0
set view 74,14,1.75,1
set view equal xyz
set pm3d depthorder
widest = larger(larger(U_max_y, -U_min_y), larger(V_max_y, -V_min_y))
set xrange [-larger(-A_min_x, -B_min_x):larger(A_max_x, B_max_x)]
set yrange [-widest:widest]
set zrange [-larger(0, larger(-A_min_y, -B_min_y)):larger(A_max_y, B_max_y)]
set tmargin at screen 0.9
set bmargin at screen 0.03
unset colorbox
set label 1 'one chamber at p_{max}' at screen 0.25,0.95 center font ',16'
set lmargin at screen 0.02
set rmargin at screen 0.46
splot one using 1:2:($6 == 0 ? $3 : NaN):(colour($4, $5)) with pm3d fc rgb variable
unset label 1
set label 2 'all chambers at p_{max}' at screen 0.67,0.95 center font ',16'
set lmargin at screen 0.46
set rmargin at screen 0.9
splot both using 1:2:($6 == 0 ? $3 : NaN):(colour($4, $5)) with pm3d fc rgb variable
unset label 2
# The scale: an empty map with the palette.
set colorbox user origin 0.92,0.2 size 0.018,0.6
set cblabel 'displacement [mm]'
set cbtics
splot NaN with pm3d fc palette
