// One sector of the ring damper: its outer face touches the landing of the blisk (blisk.geo).
// match = 1 gives it the angles of the blisk's nodes, match = 0 divisions of its own.
//
//   gmsh -3 ring.geo -setnumber order 2 -setnumber match 1 -o ring_gmsh.inp

DefineConstant[ order = 2, layers = 1, rows = 1, match = 1 ];
sectors = 24;
alpha = 2 * Pi / sectors;
blade_angle = 2 * Pi / 180;
side_angle = (alpha - blade_angle) / 2;
r[] = {0.144, 0.15};
z[] = {0.026, 0.036};

Point(1) = {r[0], 0, z[0]};
Point(2) = {r[1], 0, z[0]};
Point(3) = {r[1], 0, z[1]};
Point(4) = {r[0], 0, z[1]};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Transfinite Curve{1, 2, 3, 4} = rows + 1;
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Surface{1};
Recombine Surface{1};

volumes[] = {};
outer[] = {};
at = 1;
parts = match ? 3 : 1;
For part In {0:parts - 1}
  angle = match ? (part == 1 ? blade_angle : side_angle) : alpha;
  divisions = match ? layers : 4 * layers;
  out[] = Extrude{ {0, 0, 1}, {0, 0, 0}, angle }{ Surface{at}; Layers{divisions}; Recombine; };
  at = out[0];
  volumes[] += {out[1]};
  // The side swept by line 2, at the outer radius.
  outer[] += {out[3]};
EndFor

Physical Volume("RING") = volumes[];
Physical Surface("RING_LOW") = {1};
Physical Surface("RING_HIGH") = {at};
Physical Surface("RING_OUTER") = outer[];

Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = 1;
Mesh.SaveGroupsOfNodes = 1;
Mesh.SaveGroupsOfElements = 1;
