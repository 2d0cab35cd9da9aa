// A half disc of radius 10 on a block of 20 by 10; millimetres.
SetFactory("Built-in");
h = 2.0;   // far from the contact
f = 0.06;  // at the contact

// The block, with a finer patch of its top below the disc.
Point(1) = {0, -10, 0, h};
Point(2) = {20, -10, 0, h};
Point(3) = {20, 0, 0, h};
Point(4) = {1.5, 0, 0, 3*f};
Point(5) = {0, 0, 0, f};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 1};
Curve Loop(1) = {1, 2, 3, 4, 5};
Plane Surface(1) = {1};

// A quarter of the disc, which rests on the block at the origin.
Point(6) = {0, 0, 0, f};
Point(7) = {10*Sin(0.15), 10 - 10*Cos(0.15), 0, 3*f};
Point(8) = {10, 10, 0, h};
Point(9) = {0, 10, 0, h};
Circle(6) = {6, 9, 7};
Circle(7) = {7, 9, 8};
Line(8) = {8, 9};
Line(9) = {9, 6};
Curve Loop(2) = {6, 7, 8, 9};
Plane Surface(2) = {2};

Physical Surface("Block") = {1};
Physical Surface("Disc") = {2};
Physical Curve("Bottom") = {1};
Physical Curve("Symmetry") = {5, 9};
Physical Curve("BlockFace") = {3, 4};
Physical Curve("DiscFace") = {6, 7};
Physical Curve("Top") = {8};
