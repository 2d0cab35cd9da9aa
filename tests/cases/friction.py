"""Friction cases with closed forms: a block in uniform pressure and shear that sticks below μ p, or slides at it."""
from contact import scale_factor
from deck import *
from mesh import Box, Mesh

MULTIPLIER = "VECTOR_LAGRANGE_MULTIPLIER"
FRICTION = 0.3


def block(folder, requirement, shape, sliding, length=1.0, stress=1.0, steps=5):
    """A block on another, pressed by p and sheared along x by 0.8 μ p, or dragged over a rigid plane.

    The shear acts on the top and, as its complement, on the sides, so that both stresses are uniform. `length` and
    `stress` are the units of the deck in metres and pascals."""
    dim = int(shape[0])
    up, last = "xyz"[dim - 1], dim - 1
    young, load, drag = 1.0e9 / stress, 1.0e3 / stress, 5.0e-6 / length
    shear = (1.0 if sliding else 0.8) * FRICTION * load
    mesh = Mesh()
    wide = [(-0.5, 2.0), (-0.5, 1.3)] if sliding else [(0.0, 1.0), (0.0, 0.8)]
    sizes = [(0.0, 1.0), (0.0, 0.8)]
    corner = lambda ranges, i, z: [r[i] / length for r in ranges[:dim - 1]] + [z / length]
    low = Box(mesh, "Lower", shape, [5] * (dim - 1) + [2], corner(wide, 0, -0.5), corner(wide, 1, 0.0))
    top = Box(mesh, "Upper", shape, [4] * (dim - 1) + [2], corner(sizes, 0, 0.0), corner(sizes, 1, 0.5))
    family = "Line" if dim == 2 else "Surface"
    slave, master = top.conditions(up + "0", family), low.conditions(up + "1", family)
    mesh.part("Slave", top.side_nodes[up + "0"], (), slave)
    mesh.part("Interface", low.side_nodes[up + "1"] + top.side_nodes[up + "0"], (), slave + master)
    mesh.part("Bottom", low.side_nodes[up + "0"])
    mesh.part("Top", top.side_nodes[up + "1"], (), top.conditions(up + "1", family + "Load"))
    for name, side in (("Left", "x0"), ("Right", "x1")):
        boxes = [top] if sliding else [low, top]
        nodes = [n for box in boxes for n in box.side_nodes[side]]
        mesh.part(name, sorted(set(nodes)), (), [c for box in boxes for c in box.conditions(side, family + "Load")])
    still = {a: 0.0 for a in "xyz"[:dim]}
    constraints = [fix("Lower", **still) if sliding else fix("Bottom", **still)]
    upward = [0.0] * 3
    upward[last] = 1.0
    variable = family.upper() + "_LOAD"
    loads = [condition_load("Left", variable, -shear, upward), condition_load("Right", variable, shear, upward)]
    # One load a part: the last one written would take the place of the others.
    size = (load ** 2 + shear ** 2) ** 0.5
    pressed = [0.0] * 3
    if sliding:
        constraints.append(fix("Top", x=f"{drag}*t"))
        pressed[last] = -1.0
        loads.append(condition_load("Top", variable, load, pressed))
    else:
        pressed[0], pressed[last] = shear / size, -load / size
        loads.append(condition_load("Top", variable, size, pressed))
    bottom, height = (0.0, 0.5 / length) if sliding else (-0.5 / length, 0.5 / length)
    along, down = [0.0] * 4, [0.0] * 4
    along[last + 1] = 2.0 * shear / young
    along[0] = drag - along[last + 1] * height if sliding else -along[last + 1] * bottom
    down[last + 1] = -load / young
    down[0] = -down[last + 1] * bottom
    fields = [along, [0.0] * 4, down] if dim == 3 else [along, down]
    scale = load / young / length
    checks = []
    for box in ([top] if sliding else [low, top]):
        for axis, field in zip("XYZ", fields):
            checks.append(check("DISPLACEMENT_" + axis, 1e-5 * scale, f"{box.name.lower()}.json", affine=field))
    k = scale_factor(mesh, [(top.facets[up + "0"], young), (low.facets[up + "1"], young)])
    for axis, value in (("X", -shear), ("XYZ"[last], load)):
        checks.append(check(f"{MULTIPLIER}_{axis}", 1e-5 * load / k, "slave.json", value=value / k))
    law = "3d" if dim == 3 else "strain"
    settings = contact_solver(dim, "mesh", 1.0 / steps, "ALMContactFrictional", residual_absolute_tolerance=1e-20,
                              residual_relative_tolerance=1e-10, max_iteration=30, buffer_size=3,
                              contact_settings={
                                  "contact_residual_absolute_tolerance": 1e-20,
                                  **{f"frictional_{s}_contact_residual_{r}_tolerance": v
                                     for s in ("stick", "slip") for r, v in (("relative", 1e-9), ("absolute", 1e-20))}})
    write_case(folder, requirement,
               "Pressure and shear are uniform; loads and contact act on the deformed facets, which moves the answer by the "
               "strain, 1e-6.",
               parameters("mesh", settings, constraints, loads,
                          [contact_process([("Interface", "Slave")], "Frictional", friction_coefficients={"0": FRICTION})],
                          [json_output("lower.json", ["DISPLACEMENT"], "Lower"), json_output("upper.json", ["DISPLACEMENT"], "Upper"),
                           json_output("slave.json", [MULTIPLIER, "WEIGHTED_SLIP"], "Slave")]),
               [material("Lower", 1, law, young, 0.0), material("Upper", 2, law, young, 0.0)], mesh, checks)


def write():
    for dim, shape in ((2, "2D4N"), (3, "3D8N")):
        block(f"contact_{dim}d/friction_stick", "A block sheared by 0.8 μ p sticks to a non-matching one as if both were one.",
              shape, False, steps=1)
    block("contact_2d/friction_slide", "A block dragged over a rigid plane resists with μ p.", "2D4N", True)
    block("contact_2d/friction_slide_millimetres", "Other units of length and stress do not change how a block slides.", "2D4N", True,
          1e-3, 1e6)
