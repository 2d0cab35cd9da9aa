// A quarter of the lug: the half of lug.geo, made half as thick as it is, 5 mm, from its middle plane on. Hexahedra, or with
// `-setnumber Hexahedra 0` tetrahedra; `-setnumber Across 3` makes three of them across.
Include "lug.geo";
Delete Physicals;
DefineConstant[ Hexahedra = 1, Across = 2 ];
Mesh.SecondOrderIncomplete = 1;
// The pin touches the hole in a point, which Gmsh would make one of both bodies.
Translate {0, -1e-5, 0} { Surface{2}; }

If (Hexahedra)
  Mesh.Algorithm = 8;
  Recombine Surface{1, 2};
  l[] = Extrude {0, 0, 5} { Surface{1}; Layers{Across}; Recombine; };
  p[] = Extrude {0, 0, 5} { Surface{2}; Layers{Across}; Recombine; };
Else
  l[] = Extrude {0, 0, 5} { Surface{1}; Layers{Across}; };
  p[] = Extrude {0, 0, 5} { Surface{2}; Layers{Across}; };
EndIf

// Faces that were curves follow in the order of the loops.
Physical Volume("Lug") = {l[1]};
Physical Volume("Pin") = {p[1]};
Physical Surface("Hole") = {l[2], l[3]};
Physical Surface("PinFace") = {p[2], p[3]};
Physical Surface("PinCore") = {p[5], p[6]};
Physical Surface("Symmetry") = {l[4], l[8], p[4], p[7]};
Physical Surface("Middle") = {1, 2};
Physical Surface("Bottom") = {l[5]};
