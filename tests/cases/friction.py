"""Friction cases with closed forms: a block in uniform pressure and shear that sticks below μ p, or slides at it."""
import math

from contact import scale_factor
from deck import *
from mesh import Box, Mesh

MULTIPLIER = "VECTOR_LAGRANGE_MULTIPLIER"
FRICTION = 0.3


TIGHT = {
    "contact_residual_absolute_tolerance": 1e-20,
    **{f"frictional_{s}_contact_residual_{r}_tolerance": v
       for s in ("stick", "slip") for r, v in (("relative", 1e-9), ("absolute", 1e-20))}}


def block(folder, requirement, shape, sliding, length=1.0, stress=1.0, steps=5, limits=(FRICTION,), law="Coulomb",
          from_properties=False, kind="Frictional", shear_share=0.8, settings=None, process=None, method="ALM"):
    """A block on another, pressed by p and sheared along x by 0.8 of the limit, or dragged over a rigid plane.

    The shear acts on the top and, as its complement, on the sides, so that both stresses are uniform. `length` and
    `stress` are the units of the deck in metres and pascals. `limits` has one entry for each of several such pairs of
    blocks side by side: a coefficient, or for Tresca's law the limit as a share of p. `kind` is the contact type, `method`
    the formulation: a penalty yields a little, and its tractions stand for multipliers."""
    dim = int(shape[0])
    up, last = "xyz"[dim - 1], dim - 1
    young, load, drag = 1.0e9 / stress, 1.0e3 / stress, 5.0e-6 / length
    relative = 1e-3 if method == "Penalty" else 1e-5
    mesh = Mesh()
    sizes = [(0.0, 1.0), (0.0, 0.8)]
    family = "Line" if dim == 2 else "Surface"
    variable = family.upper() + "_LOAD"
    still = {a: 0.0 for a in "xyz"[:dim]}
    constraints, loads, checks, materials, pairs, outputs, given = [], [], [], [], [], [], {}
    sides = []
    for number, limit in enumerate(limits):
        mark = "" if len(limits) == 1 else str(number)
        shear = (1.0 if sliding else shear_share) * min(limit, FRICTION if limit > 1.0 else limit) * load
        wide = [(-0.5, 2.0), (-0.5, 1.3)] if sliding else [(0.0, 1.0), (0.0, 0.8)]
        shift = [4.0 * number] + [0.0] * (dim - 2)
        corner = lambda ranges, i, z: [(r[i] + d) / length for r, d in zip(ranges[:dim - 1], shift)] + [z / length]
        low = Box(mesh, "Lower" + mark, shape, [5] * (dim - 1) + [2], corner(wide, 0, -0.5), corner(wide, 1, 0.0))
        top = Box(mesh, "Upper" + mark, shape, [4] * (dim - 1) + [2], corner(sizes, 0, 0.0), corner(sizes, 1, 0.5))
        slave, master = top.conditions(up + "0", family), low.conditions(up + "1", family)
        mesh.part("Slave" + mark, top.side_nodes[up + "0"], (), slave)
        mesh.part("Interface" + mark, low.side_nodes[up + "1"] + top.side_nodes[up + "0"], (), slave + master)
        pairs.append(("Interface" + mark, "Slave" + mark))
        mesh.part("Bottom" + mark, low.side_nodes[up + "0"])
        mesh.part("Top" + mark, top.side_nodes[up + "1"], (), top.conditions(up + "1", family + "Load"))
        for name, side in (("Left", "x0"), ("Right", "x1")):
            boxes = [top] if sliding else [low, top]
            nodes = [n for box in boxes for n in box.side_nodes[side]]
            mesh.part(name + mark, sorted(set(nodes)), (), [c for box in boxes for c in box.conditions(side, family + "Load")])
        constraints.append(fix("Lower" + mark, **still) if sliding else fix("Bottom" + mark, **still))
        upward = [0.0] * 3
        upward[last] = 1.0
        loads += [condition_load("Left" + mark, variable, -shear, upward), condition_load("Right" + mark, variable, shear, upward)]
        # One load a part: the last one written would take the place of the others.
        size = (load ** 2 + shear ** 2) ** 0.5
        pressed = [0.0] * 3
        if sliding:
            constraints.append(fix("Top" + mark, x=f"{drag}*t"))
            pressed[last] = -1.0
            loads.append(condition_load("Top" + mark, variable, load, pressed))
        else:
            pressed[0], pressed[last] = shear / size, -load / size
            loads.append(condition_load("Top" + mark, variable, size, pressed))
        bottom, height = (0.0, 0.5 / length) if sliding else (-0.5 / length, 0.5 / length)
        along, down = [0.0] * 4, [0.0] * 4
        along[last + 1] = 2.0 * shear / young
        along[0] = drag - along[last + 1] * height if sliding else -along[last + 1] * bottom
        down[last + 1] = -load / young
        down[0] = -down[last + 1] * bottom
        fields = [along, [0.0] * 4, down] if dim == 3 else [along, down]
        scale = load / young / length
        for box in ([top] if sliding else [low, top]):
            for axis, field in zip("XYZ", fields):
                checks.append(check("DISPLACEMENT_" + axis, relative * scale, f"{box.name.lower()}.json", affine=field))
        sides += [(top.facets[up + "0"], young), (low.facets[up + "1"], young)]
        if method == "Penalty":
            checks += [check("FRICTION_TRACTION_X", relative * load, f"slave{mark}.json", value=-shear),
                       check("AUGMENTED_NORMAL_CONTACT_PRESSURE", relative * load, f"pressure{mark}.json", value=-load)]
            outputs.append(json_output(f"pressure{mark}.json", ["AUGMENTED_NORMAL_CONTACT_PRESSURE"], "Slave" + mark, historical=False))
        else:
            for axis, value in (("X", -shear), ("XYZ"[last], load)):
                checks.append((f"{MULTIPLIER}_{axis}", f"slave{mark}.json", value))
        outputs += [json_output(f"{box.name.lower()}.json", ["DISPLACEMENT"], box.name) for box in (low, top)]
        tractions = "FRICTION_TRACTION" if method == "Penalty" else MULTIPLIER
        outputs.append(json_output(f"slave{mark}.json", [tractions, "WEIGHTED_SLIP"], "Slave" + mark))
        more = {}
        if law == "Tresca":
            more["TRESCA_FRICTION_THRESHOLD"] = limit * load
        elif from_properties:
            more["FRICTION_COEFFICIENT"] = limit
        given[str(number)] = 0.9 if from_properties else limit
        name = "3d" if dim == 3 else "strain"
        materials += [material(box.name, len(materials) + 1 + i, name, young, 0.0, **more) for i, box in enumerate((low, top))]
    k = scale_factor(mesh, sides)
    checks = [c if isinstance(c, dict) else check(c[0], 1e-5 * load / k, c[1], value=c[2] / k) for c in checks]
    solver_settings = contact_solver(dim, "mesh", 1.0 / steps, method + "Contact" + kind, residual_absolute_tolerance=1e-20,
                                     residual_relative_tolerance=1e-10, max_iteration=30, buffer_size=3,
                                     contact_settings=TIGHT, **(settings or {}))
    friction = {"frictional_law": law} if law != "Coulomb" else {"friction_coefficients": given}
    write_case(folder, requirement,
               "Pressure and shear are uniform; loads and contact act on the deformed facets, which moves the answer by the "
               "strain, 1e-6.",
               parameters("mesh", solver_settings, constraints, loads,
                          [contact_process(pairs, kind, method.lower(), **friction, **(process or {}))], outputs), materials, mesh, checks)


def arc():
    """A pressed column cut along an arc whose slope stays below the angle of friction."""
    radius, young, load, friction, count = 1.9, 1.0e9, 1.0e3, 0.3, 6
    bulge = lambda x: math.sqrt(radius ** 2 - (x - 0.5) ** 2) - radius
    mesh = Mesh()
    low = Box(mesh, "Lower", "2D4N", [count, 2], [0.0, 0.0], [1.0, 0.5], lambda x, y: (x, y + 2.0 * y * bulge(x)))
    top = Box(mesh, "Upper", "2D4N", [count, 2], [0.0, 0.5], [1.0, 1.0], lambda x, y: (x, y + 2.0 * (1.0 - y) * bulge(x)))
    slave, master = top.conditions("y0", "Line"), low.conditions("y1", "Line")
    mesh.part("Slave", top.side_nodes["y0"], (), slave)
    mesh.part("Interface", low.side_nodes["y1"] + top.side_nodes["y0"], (), slave + master)
    mesh.part("Bottom", low.side_nodes["y0"])
    mesh.part("Top", top.side_nodes["y1"], (), top.conditions("y1", "LineLoad"))
    settings = contact_solver(2, "mesh", 1.0, "ALMContactFrictional", residual_absolute_tolerance=1e-20,
                              residual_relative_tolerance=1e-10, max_iteration=30, buffer_size=3, contact_settings=TIGHT)
    slope = -load / young
    write_case("contact_2d/friction_arc", "A column cut along an arc below the angle of friction bears its load as if it were whole.",
               f"The slope of the arc reaches {0.5 / math.sqrt(radius ** 2 - 0.25):.3f}, the coefficient is {friction}; meshes match, so that "
               "nodal forces can balance uniform stress. Contact acts on the deformed facets, which moves the answer by the strain.",
               parameters("mesh", settings, [fix("Bottom", x=0.0, y=0.0)], [condition_load("Top", "LINE_LOAD", load, [0.0, -1.0, 0.0])],
                          [contact_process([("Interface", "Slave")], "Frictional", friction_coefficients={"0": friction})],
                          [json_output("results.json", ["DISPLACEMENT"])]),
               [material("Lower", 1, "strain", young, 0.0), material("Upper", 2, "strain", young, 0.0)], mesh,
               affine_checks([[0.0] * 4, [0.0, 0.0, slope, 0.0]], 1e-5))


def sleeve():
    """A sleeve shrunk on a rigid shaft by outer pressure and pulled along it: axisymmetric friction."""
    inner, outer, length, young, pressure, friction = 1.0, 1.5, 4.0, 1.0e9, 1.0e4, 0.1
    mesh = Mesh()
    shaft = Box(mesh, "Shaft", "2D4N", [1, 26], [0.6, -0.6], [inner, length + 0.6])
    ring = Box(mesh, "Sleeve", "2D4N", [8, 48], [inner, 0.0], [outer, length])
    for box in (shaft, ring):
        for number in box.elements:
            name, cell = mesh.elements[number - 1]
            mesh.elements[number - 1] = ("Axisym" + name, cell)
    slave, master = ring.conditions("x0", "Line"), shaft.conditions("x1", "Line")
    mesh.part("Slave", ring.side_nodes["x0"], (), slave)
    mesh.part("Interface", shaft.side_nodes["x1"] + ring.side_nodes["x0"], (), slave + master)
    mesh.part("Outside", ring.side_nodes["x1"], (), ring.conditions("x1", "AxisymLineLoad"))
    middle = [n for n in ring.side_nodes["x0"] if abs(mesh.nodes[n][1] - length / 2) < 0.4]
    contact = 2.0 * pressure * outer ** 2 / (inner ** 2 + outer ** 2)
    checks = [check(MULTIPLIER + "_X", 0.01 * contact, "slave.json", nodes=middle, value=contact),
              check(MULTIPLIER + "_Y", 0.01 * friction * contact, "slave.json", nodes=middle, value=-friction * contact)]
    settings = contact_solver(2, "mesh", 0.5, "ALMContactFrictional", residual_absolute_tolerance=1e-20,
                              residual_relative_tolerance=1e-9, max_iteration=30, buffer_size=3, contact_settings=TIGHT)
    materials = [material(box.name, i, "strain", young, 0.0, THICKNESS=1.0) for i, box in enumerate((shaft, ring), 1)]
    for entry in materials:
        entry["Material"]["constitutive_law"]["name"] = "LinearElasticAxisym2DLaw"
    write_case("contact_2d/friction_sleeve", "A sleeve pulled along a rigid shaft resists with μ times the pressure of Lamé's solution.",
               "Lamé's thick ring on a core that does not yield, away from the ends by three times the wall; eight elements through it.",
               parameters("mesh", settings, [fix("Shaft", x=0.0, y=0.0), fix("Outside", y="5e-5*t")],
                          [condition_load("Outside", "LINE_LOAD", pressure, [-1.0, 0.0, 0.0])],
                          [contact_process([("Interface", "Slave")], "Frictional", friction_coefficients={"0": friction},
                                           advance_ALM_parameters={"use_scale_factor": False},
                                           alternative_formulations={"axisymmetric": True})],
                          [json_output("slave.json", [MULTIPLIER], "Slave")]), materials, mesh, checks)


def write():
    for dim, shape in ((2, "2D4N"), (3, "3D8N")):
        block(f"contact_{dim}d/friction_stick", "A block sheared by 0.8 μ p sticks to a non-matching one as if both were one.",
              shape, False, steps=1)
        block(f"contact_{dim}d/friction_slide", "A block dragged over a rigid plane resists with μ p.", shape, True)
        block(f"contact_{dim}d/friction_tresca_slide", "Under Tresca's law a dragged block resists with the limit of the law.",
              shape, True, law="Tresca", limits=(0.2,))
        block(f"contact_{dim}d/friction_penalty_stick", "By the penalty method a block sheared by 0.8 μ p sticks.",
              shape, False, steps=1, method="Penalty")
        block(f"contact_{dim}d/friction_penalty_slide", "By the penalty method a dragged block resists with μ p.",
              shape, True, method="Penalty")
    block("contact_2d/friction_tresca_stick", "Under Tresca's law a block sheared by 0.8 of the limit sticks.", "2D4N", False,
          steps=1, law="Tresca", limits=(0.2,))
    block("contact_3d/friction_iterative_engine", "GMRES on condensed multipliers lets a sheared block stick.", "3D8N", False,
          steps=1, settings={"linear_solver_settings": {"solver_type": "gmres", "tolerance": 1e-11}})
    block("contact_2d/friction_perfect_stick", "With a huge coefficient of friction a sheared block is tied.", "2D4N", False,
          steps=1, limits=(1e9,))
    block("contact_2d/friction_pure_slip", "A formulation that always slides resists with μ p from the first step on.", "2D4N", True,
          kind="FrictionalPureSlip")
    block("contact_2d/friction_none", "With a coefficient of zero a dragged block slides freely.", "2D4N", True, limits=(0.0,))
    block("contact_2d/friction_by_pair", "Each pair slides by its own entry of friction_coefficients.", "2D4N", True,
          limits=(0.2, 0.4))
    block("contact_2d/friction_from_properties", "FRICTION_COEFFICIENT of the material goes before friction_coefficients.",
          "2D4N", True, from_properties=True)
    block("contact_2d/friction_slide_millimetres", "Other units of length and stress do not change how a block slides.", "2D4N", True,
          1e-3, 1e6)
    arc()
    sleeve()
