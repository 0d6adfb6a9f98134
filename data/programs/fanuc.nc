%
O0001 (PIPE.STL)
(meshwind test)
(mandrel: pipe.stl)
(mandrel digest: sha256/128 00000000000000000000000000000000)
(machine: Six-axis winder)
(job digest: sha256/128 11111111111111111111111111111111)
(fibre: 12.345 m)
(time: 39.9 s)
(blocks: 99)
(tie on at X70.000 Y0.000 Z-1.500 on the mandrel)
G21 G90 G94 G17 G40 G49
(approach: rotary axes turn first, then the linear axes move together.)
(bring the eye clear of the mandrel by hand before the start)
G90 G0 A0.000 B0.000 C-70.529
G90 G0 X150.000 Y0.000 Z81.421
(tie the fibre on at the landing point, then start again)
M0
G91 G93
(course 0)
G1 Z78.540 C-90.000 F20.
G1 X2.500 Z0.039 C-13.471 F240.
(course 1)
G1 X-2.500 Z-78.579 C-90.000 F20.
(course 2)
M98 P1001 L11
(course 13)
G1 Z10.000 C-17.682 F171.429
M98 P1002
M30
O1001
G1 Z10.000 C-17.678 F171.429
M98 P1002
M99
O1002
G1 Z10.000 C-17.677 F171.429
G1 Z10.000 C-17.678 F171.429
G1 X1.000 Z10.000 C-17.678 F171.429
G1 X-1.000 Z-10.000 C-17.677 F171.429
G1 Z-10.000 C-17.678 F171.429
G1 Z-10.000 C-17.678 F171.429
G1 Z-10.000 C-17.677 F171.429
M99
%
