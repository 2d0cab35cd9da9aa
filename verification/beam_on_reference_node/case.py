"""A cantilever whose end follows a reference node: a moment, and a prescribed rotation."""
from lib.case import Case, Outcome, Quantity
from lib.model import Model
from lib.solution import solve

LENGTH, HEIGHT, YOUNG, MOMENT = 10.0, 1.0, 1e6, 1.0
INERTIA = HEIGHT ** 3 / 12
ROTATION = MOMENT * LENGTH / (YOUNG * INERTIA)


def run(shape="2D8N", coupling="kinematic", driven=False, poisson=0.3, length=1.0, stress=1.0):
    m = Model(2, length, stress)
    beam = m.box("Beam", shape, [4, 2], [0.0, -0.5 * HEIGHT], [LENGTH, 0.5 * HEIGHT])
    m.material(beam, "stress", YOUNG, poisson, THICKNESS=length)
    m.fix(beam.side_nodes["x0"], x=0.0)
    m.fix([i for i in beam.side_nodes["x0"] if m.mesh.nodes[i][1] == 0.0], y=0.0)
    made = beam.conditions("x1", "Line")
    tip = m.part(beam.side_nodes["x1"], made, "Tip")
    settings = {"model_part_name": "Structure." + tip, "reference_model_part_name": "Structure.Hub", "reference_point": [LENGTH * length, 0.0, 0.0]}
    if coupling == "kinematic":
        settings["components"] = [True, False, False]  # the end is free to narrow
    elif driven:
        settings["reference_node_leads"] = True
    m.process(coupling + "_coupling_process", settings)
    moment = MOMENT * m.stress * m.length ** 3
    if coupling == "kinematic":
        m.process("assign_vector_variable_process", {"model_part_name": "Structure.Hub", "variable_name": "DISPLACEMENT",
            "constrained": [False, True, False], "value": [None, 0.0, None], "interval": [0.0, "End"]})
    if driven:
        m.process("assign_vector_variable_process", {"model_part_name": "Structure.Hub", "variable_name": "ROTATION",
            "constrained": [False, False, True], "value": [None, None, ROTATION], "interval": [0.0, "End"]})
    else:
        m.process("assign_vector_variable_to_conditions_process", {"model_part_name": "Structure.Hub", "variable_name": "POINT_MOMENT",
            "value": [0.0, 0.0, moment], "interval": [0.0, "End"]}, "loads")
    s = solve(m)
    end = [i for i in beam.side_nodes["x1"] if m.mesh.nodes[i][1] == 0.0]
    given = s.number("REACTION_MOMENT_Z of Structure.Hub") / moment if driven else 1.0
    return Outcome(s, {"rotation": s.number("ROTATION_Z of Structure.Hub") / ROTATION, "moment": given,
                       "deflection": s.u(end)[end[0]][1] / (0.5 * ROTATION * LENGTH)})


CASE = Case(
    "Cantilever on a reference node", "S. Timoshenko, Strength of Materials I, § 35", "ANALYTIC",
    "A moment M at the end of a cantilever in plane stress rotates it by M L/EI and bends it by M L²/2EI. Elements of second order hold this "
    "exactly, for any Poisson's ratio where the end is free to narrow: 1e-10 of the iteration. Values are shares of the closed form.",
    [Quantity(name, 1.0, 1e-9, order=False) for name in ("rotation", "moment", "deflection")],
    (1,), lambda mesh, **settings: run(**settings),
    variants={"kinematic (RBE2)": {}, "kinematic, rotation given": {"driven": True}, "distributing (RBE3)": {"coupling": "distributing"},
              "distributing, rotation given": {"coupling": "distributing", "driven": True}, "triangles": {"shape": "2D6N", "coupling": "distributing"},
              "millimetres": {"coupling": "distributing", "length": 1e3, "stress": 1e-6}},
    quick=["kinematic (RBE2)", "distributing (RBE3)"])
