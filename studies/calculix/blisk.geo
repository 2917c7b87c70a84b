// One sector of a blisk: disk, rim with a flange, blade. Drawn in the plane theta = 0 (x is the radius,
// z the axis of rotation), then turned about z in three parts; the blade stands on the middle one.
//
//   gmsh -3 blisk.geo -setnumber order 2 -setnumber layers 1 -o blisk_gmsh.inp

DefineConstant[ order = 2, layers = 1, rows = 1 ];
sectors = 24;
alpha = 2 * Pi / sectors;
blade_angle = 2 * Pi / 180;
side_angle = (alpha - blade_angle) / 2;

// Radii, m: bore, rim, inner face of the flange (where the ring presses), platform, tip.
r[] = {0.06, 0.135, 0.15, 0.16, 0.24};
// Axial positions, m: rim, web, rim and flange, landing of the ring.
z[] = {-0.02, -0.006, 0.006, 0.02, 0.026, 0.036};

Function Quad
  // Vertices from (i, j) to (i + 1, j + 1) of the grid of radii and axial positions.
  a = newp; Point(a) = {r[i], 0, z[j]};
  b = newp; Point(b) = {r[i + 1], 0, z[j]};
  c = newp; Point(c) = {r[i + 1], 0, z[j + 1]};
  d = newp; Point(d) = {r[i], 0, z[j + 1]};
  l1 = newl; Line(l1) = {a, b};
  l2 = newl; Line(l2) = {b, c};
  l3 = newl; Line(l3) = {c, d};
  l4 = newl; Line(l4) = {d, a};
  radial = (i == 0) ? 2 * rows : (i == 3 ? 3 * rows : rows);
  Transfinite Curve{l1, l3} = radial + 1;
  Transfinite Curve{l2, l4} = rows + 1;
  ll = newll; Curve Loop(ll) = {l1, l2, l3, l4};
  quad = news; Plane Surface(quad) = {ll};
  Transfinite Surface{quad};
  Recombine Surface{quad};
Return

disk[] = {};
i = 0;
j = 1;
Call Quad;
disk[] += {quad};
For i In {1:2}
  For j In {0:2}
    Call Quad;
    disk[] += {quad};
  EndFor
EndFor
i = 2;
For j In {3:4}
  Call Quad;
  disk[] += {quad};
EndFor
blade[] = {};
i = 3;
For j In {0:2}
  Call Quad;
  blade[] += {quad};
EndFor
Coherence;

low[] = disk[];
volumes[] = {};
blade_volumes[] = {};
at[] = disk[];
For part In {0:2}
  angle = (part == 1) ? blade_angle : side_angle;
  next[] = {};
  For s In {0:#at[] - 1}
    out[] = Extrude{ {0, 0, 1}, {0, 0, 0}, angle }{ Surface{at[s]}; Layers{layers}; Recombine; };
    next[] += {out[0]};
    volumes[] += {out[1]};
  EndFor
  at[] = next[];
EndFor
turned[] = Rotate{ {0, 0, 1}, {0, 0, 0}, side_angle }{ Duplicata{ Surface{blade[]}; } };
Recursive Delete{ Surface{blade[]}; }
For s In {0:#turned[] - 1}
  // Copies have no mesh rules.
  side[] = Boundary{ Surface{turned[s]}; };
  Transfinite Curve{side[0], side[2]} = 3 * rows + 1;
  Transfinite Curve{side[1], side[3]} = rows + 1;
  Transfinite Surface{turned[s]};
  Recombine Surface{turned[s]};
EndFor
For s In {0:#turned[] - 1}
  out[] = Extrude{ {0, 0, 1}, {0, 0, 0}, blade_angle }{ Surface{turned[s]}; Layers{layers}; Recombine; };
  blade_volumes[] += {out[1]};
EndFor
Coherence;

// Every region that the import names. The surfaces are found by boxes round them.
eps = 1e-6;
bore() = Surface In BoundingBox{0, -eps, z[1] - eps, r[0] + eps, r[0], z[2] + eps};
contact() = Surface In BoundingBox{
  r[2] * Cos(alpha) - eps, -eps, z[4] - eps, r[2] + eps, r[2], z[5] + eps};
tip() = Point In BoundingBox{
  r[4] * Cos(side_angle) - eps, r[4] * Sin(side_angle) - eps, z[0] - eps,
  r[4] * Cos(side_angle) + eps, r[4] * Sin(side_angle) + eps, z[0] + eps};
Physical Volume("DISK") = volumes[];
Physical Volume("BLADE") = blade_volumes[];
Physical Surface("LOW") = low[];
Physical Surface("HIGH") = at[];
Physical Surface("BORE") = bore[];
Physical Surface("LANDING") = contact[];
Physical Point("TIP") = tip[];

Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = 1;
Mesh.SaveGroupsOfNodes = 1;
Mesh.SaveGroupsOfElements = 1;
