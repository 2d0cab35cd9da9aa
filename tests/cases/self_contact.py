"""Self-contact: a body with a slit whose lips press on each other; no side is named."""
from deck import *
from mesh import Box, Mesh

YOUNG, POISSON, LOAD = 2.0e9, 0.3, 1.0e6


def sew(mesh, lower, upper, up, tip):
    """Joins both boxes beyond the slit, which goes from x = 0 to x = `tip`; the upper box keeps its own nodes there."""
    at = {mesh.nodes[i]: i for i in lower.side_nodes[up + "1"]}
    same = {i: at[mesh.nodes[i]] for i in upper.side_nodes[up + "0"] if mesh.nodes[i][0] > tip - 1e-9}
    swap = lambda nodes: tuple(same.get(i, i) for i in nodes)
    mesh.elements = [(name, swap(nodes)) for name, nodes in mesh.elements]
    upper.facets = {side: [swap(f) for f in facets] for side, facets in upper.facets.items()}
    upper.side_nodes = {side: sorted(swap(nodes)) for side, nodes in upper.side_nodes.items()}
    for i in sorted(same, reverse=True):
        drop_node(mesh, (lower, upper), i)
    upper.nodes = sorted(set(n for _, nodes in mesh.elements[len(lower.elements):] for n in nodes))
    mesh.part(lower.name, lower.nodes, lower.elements)
    mesh.part(upper.name, upper.nodes, upper.elements)


def drop_node(mesh, boxes, gone):
    """Removes a node that no element has any more; later ones move up by one number."""
    move = lambda nodes: type(nodes)(i - (i > gone) for i in nodes if i != gone)
    mesh.nodes = {i - (i > gone): at for i, at in mesh.nodes.items() if i != gone}
    mesh.elements = [(name, move(nodes)) for name, nodes in mesh.elements]
    for box in boxes:
        box.nodes = move(box.nodes)
        box.facets = {side: [move(f) for f in facets] for side, facets in box.facets.items()}
        box.side_nodes = {side: move(nodes) for side, nodes in box.side_nodes.items()}


def slit(folder, shape, components=False):
    """A closed slit must not show under uniform pressure across it: stress stays uniform, also at its tip."""
    dim = int(shape[0])
    up, last = "xyz"[dim - 1], dim - 1
    size = [2.0, 0.8][:dim - 1]
    divisions = [6, 2][:dim - 1] + [2]
    mesh = Mesh()
    low = Box(mesh, "Lower", shape, divisions, [0.0] * dim, size + [1.0])
    top = Box(mesh, "Upper", shape, divisions, [0.0] * (dim - 1) + [1.0], size + [2.0])
    tip = 4.0 / 3.0
    sew(mesh, low, top, up, tip)
    family = "Line" if dim == 2 else "Surface"
    in_slit = lambda centre: centre[0] < tip
    lips = top.conditions(up + "0", family, in_slit) + low.conditions(up + "1", family, in_slit)
    on_lips = sorted({i for c in lips for i in mesh.condition_list[c - 1][1]})
    mesh.part("Lips", on_lips, (), lips)
    mesh.part("Bottom", low.side_nodes[up + "0"])
    mesh.part("Top", top.side_nodes[up + "1"], (), top.conditions(up + "1", family + "Load"))
    constraints = [fix("Bottom", **{up: 0.0})]
    both = {a: set(low.side_nodes[a + "0"] + low.side_nodes[a + "1"] + top.side_nodes[a + "0"] + top.side_nodes[a + "1"])
            for a in "xyz"[:dim - 1]}
    constraints += [fix(mesh.part("Sides" + a.upper(), nodes), **{a: 0.0}) for a, nodes in both.items()]
    press = 1.0 / oedometer(YOUNG, POISSON)
    field = {a: [0.0] * 4 for a in "xyz"[:dim - 1]}
    field[up] = [0.0] + [-LOAD * press if i == last else 0.0 for i in range(3)]
    scale = LOAD * press
    checks = [check("DISPLACEMENT_" + a.upper(), 1e-7 * scale, f"{box}.json", affine=f)
              for box in ("lower", "upper") for a, f in field.items()]
    kind = "FrictionlessComponents" if components else "Frictionless"
    unknown = "VECTOR_LAGRANGE_MULTIPLIER" if components else "LAGRANGE_MULTIPLIER_CONTACT_PRESSURE"
    contact = process("alm_contact_process", {
        "model_part_name": "Structure", "contact_type": kind, "contact_model_part": {"0": ["Lips"]},
        "assume_master_slave": {}}, CONTACT)
    write_case(folder, "The lips of a slit in one body find each other and press; the nodes at its tip are on both.",
               "In a confined block under uniform pressure a closed slit leaves the stress uniform; the tolerance is that of the iteration.",
               parameters("mesh", contact_solver(dim, "mesh", mortar="ALMContact" + kind), constraints,
                          [condition_load("Top", ("LINE" if dim == 2 else "SURFACE") + "_LOAD", LOAD,
                                          [-1.0 if a == up else 0.0 for a in "xyz"])], [contact],
                          [json_output("lower.json", ["DISPLACEMENT"], "Lower"), json_output("upper.json", ["DISPLACEMENT"], "Upper"),
                           json_output("lips.json", [unknown], "Lips")]),
               [material("Lower", 1, "3d" if dim == 3 else "strain", YOUNG, POISSON),
                material("Upper", 2, "3d" if dim == 3 else "strain", YOUNG, POISSON)], mesh, checks)


def write():
    slit("self_contact/slit", "2D4N")
    slit("self_contact/slit_components", "2D4N", components=True)
    slit("self_contact/slit_triangles", "2D3N")
    slit("self_contact/slit_hexahedra", "3D8N")
    slit("self_contact/slit_tetrahedra", "3D4N")
