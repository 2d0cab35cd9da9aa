"""A problem as a deck: bodies, interfaces, supports and loads, in the units and the direction a case asks for.

Lengths and stresses are given in the numbers of the case; `length` and `stress` say how many units of the deck one of them
is, and `turn` (an angle in degrees about z) where the case's x axis points in the deck. Results come back in the numbers of the case."""
import itertools, math

from deck import KRATOS, contact_process, parameters, process
from mesh import SHAPES, Box, Mesh

STRUCTURE = KRATOS + ".StructuralMechanicsApplication"
# name of the family -> process, contact type, mortar type
FAMILIES = {
    "ALM": ("alm_contact_process", "Frictionless", "ALMContactFrictionless"),
    "ALM components": ("alm_contact_process", "FrictionlessComponents", "ALMContactFrictionlessComponents"),
    "ALM frictional": ("alm_contact_process", "Frictional", "ALMContactFrictional"),
    "penalty": ("penalty_contact_process", "Frictionless", "PenaltyContactFrictionless"),
    "penalty frictional": ("penalty_contact_process", "Frictional", "PenaltyContactFrictional"),
    "explicit penalty": ("explicit_penalty_contact_process", "Frictionless", "PenaltyContactFrictionless"),
    "explicit penalty frictional": ("explicit_penalty_contact_process", "Frictional", "PenaltyContactFrictional"),
    "Uzawa": ("uzawa_contact_process", "Frictionless", "UzawaContactFrictionless"),
    "Nitsche": ("nitsche_contact_process", "Frictionless", "NitscheContactFrictionless"),
    "Nitsche frictional": ("nitsche_contact_process", "Frictional", "NitscheContactFrictional"),
    "perturbed": ("perturbed_lagrangian_contact_process", "Frictionless", "PerturbedLagrangianContactFrictionless"),
    "MPC": ("mpc_contact_process", "Frictionless", None),
    "MPC frictional": ("mpc_contact_process", "Frictional", None),
    "MPC tie": ("mpc_contact_process", "MeshTying", None),
    "tie": ("mesh_tying_process", None, "ComponentsMeshTying"),
}
FRICTIONLESS = ["ALM", "ALM components", "penalty", "Uzawa", "perturbed", "Nitsche", "MPC"]
FRICTIONAL = ["ALM frictional", "penalty frictional", "Nitsche frictional", "MPC frictional"]
LAWS = {"3d": "LinearElastic3DLaw", "strain": "LinearElasticPlaneStrain2DLaw", "stress": "LinearElasticPlaneStress2DLaw",
        "axis": "LinearElasticAxisym2DLaw", "hyper": "HyperElasticPlaneStrain2DLaw", "hyper3d": "HyperElastic3DLaw"}


def ramp(begin, end):
    """A function of time: 0 up to `begin`, then even to 1 at `end`, and 1 from there."""
    return f"(0.5 + 0.5*(abs(t - {begin!r}) - abs(t - {end!r}))/{end - begin!r})"


class ExactMesh(Mesh):
    """A mesh whose coordinates are written with all their digits, and whose nodes may be taken away again."""

    def add_node(self, at):
        self.last = number = getattr(self, "last", 0) + 1
        self.nodes[number] = tuple(at) + (0.0,) * (3 - len(at))
        return number

    def text(self):
        rows = "".join(f"{i} {x!r} {y!r} {z!r}\n" for i, (x, y, z) in self.nodes.items())
        head, rest = super().text().split("Begin Nodes\n", 1)
        return head + "Begin Nodes\n" + rows + "End Nodes\n" + rest.split("End Nodes\n", 1)[1]


class Model:
    def __init__(self, dim, length=1.0, stress=1.0, turn=0.0, axis=(0.0, 0.0, 1.0)):
        self.dim, self.length, self.stress, self.turn, self.about = dim, length, stress, math.radians(turn), axis
        self.mesh, self.materials, self.processes, self.pairs, self.watched = ExactMesh(), [], [], [], {}
        self.bodies, self.force_scale = [], stress * length ** (dim - 1)
        self.ids = itertools.count()

    # --- bodies -------------------------------------------------------------------------------------------------------------

    def box(self, name, shape, divisions, low, high, mapping=None, wrap=None, element="SmallDisplacementElement", **more):
        """A body of cells; `mapping` bends it; `wrap` joins the two sides across that axis ("x", "y") to a ring."""
        body = Box(self.mesh, name, shape, list(divisions), list(low), list(high), mapping, element=element, **more)
        self._give_middles(body, mapping)
        if wrap:
            self._join(body, wrap)
        self.bodies.append(body)
        if element.startswith("Axisym"):  # forces are those of the whole turn
            self.force_scale = self.stress * self.length ** 2
        return body

    def graded(self, name, shape, stations, mapping=None, **more):
        """A body whose planes of nodes stand at the given `stations` along each axis."""
        exact = lambda k: 0.5 * round(2 * k)  # middle nodes of second order stand half-way
        def at(*i):
            point = [s[int(k)] + (k - int(k)) * (s[min(int(k) + 1, len(s) - 1)] - s[int(k)]) for s, k in zip(stations, map(exact, i))]
            return mapping(*point) if mapping else point
        counts = [len(s) - 1 for s in stations]
        return self.box(name, shape, counts, [0] * len(counts), counts, at, **more)

    def _give_middles(self, body, mapping):
        """Middle nodes of a body of second order: on the curves that the mapping makes of edges, and in the facets of its sides."""
        _, groups = SHAPES[body.shape]
        corners = len(body.cells[0]) - len(groups)
        middle = {tuple(sorted(cell[i] for i in g)): node for cell in body.cells for g, node in zip(groups, cell[corners:])}
        for node in middle.values():
            if mapping:
                self.mesh.nodes[node] = tuple(mapping(*body.reference[node])) + (0.0,) * (3 - self.dim)
        def raised(facet):
            ends = zip(facet, facet[1:] + facet[:1]) if len(facet) > 2 else [facet]
            keys = [tuple(sorted(e)) for e in ends] + [tuple(sorted(facet))] * (len(facet) > 2)
            return facet + tuple(middle[k] for k in keys if k in middle)
        body.facets = {side: [raised(tuple(f)) for f in facets] for side, facets in body.facets.items()}

    def _join(self, body, axis):
        mesh, into = self.mesh, {}
        beside = lambda i: tuple(c for c, letter in zip(body.reference[i], "xyz") if letter != axis)
        low = {beside(i): i for i in body.side_nodes[axis + "0"]}
        for i in body.side_nodes[axis + "1"]:
            into[i] = low[beside(i)]
            del mesh.nodes[i]
        change = lambda ids: tuple(into.get(i, i) for i in ids)
        for number in body.elements:
            name, cell = mesh.elements[number - 1]
            mesh.elements[number - 1] = (name, change(cell))
        body.cells = [change(cell) for cell in body.cells]
        body.nodes = sorted(set(change(body.nodes)))
        body.side_nodes = {s: sorted(set(change(ids))) for s, ids in body.side_nodes.items()}
        body.facets = {s: [change(f) for f in facets] for s, facets in body.facets.items() if s[0] != axis}
        mesh.part(body.name, body.nodes, body.elements)

    def material(self, body, law, young, poisson=0.0, **variables):
        scaled = {"YOUNG_MODULUS": young * self.stress, "POISSON_RATIO": poisson, **variables}
        if law == "axis":
            scaled.setdefault("THICKNESS", 1.0)
        self.materials.append({"model_part_name": "Structure." + body.name, "properties_id": len(self.materials) + 1, "Material": {
            "constitutive_law": {"name": LAWS.get(law, law)}, "Variables": scaled, "Tables": {}}})

    # --- supports, loads ----------------------------------------------------------------------------------------------------

    def part(self, nodes, conditions=(), prefix="Part"):
        return self.mesh.part(f"{prefix}{next(self.ids)}", set(nodes), (), conditions)

    def fix(self, nodes, x=None, y=None, z=None):
        """Prescribes displacements: numbers, or expressions of t. Turned models take vectors of expressions only where full."""
        given = [x, y, z]
        if self.turn:
            if any(v is None for v in given[:self.dim]):
                raise ValueError("a turned model can only prescribe all components")
            given = self._turned(given)
        values = [None if v is None else (v * self.length if isinstance(v, (int, float)) else f"({v})*{self.length!r}") for v in given]
        self.processes.append(("constraints", process("assign_vector_variable_process", {
            "model_part_name": "Structure." + self.part(nodes), "variable_name": "DISPLACEMENT",
            "constrained": [v is not None for v in values], "value": values, "interval": [0.0, "End"]})))

    def roll(self, nodes, x=None, y=None, z=None):
        """As `fix`, said by name where a model is never turned."""
        self.fix(nodes, x, y, z)

    def _turned(self, given):
        rows = self.rotation()
        text = ["0.0" if v is None else (repr(float(v)) if isinstance(v, (int, float)) else f"({v})") for v in given]
        out = []
        for i in range(self.dim):
            out.append("+".join(f"({rows[i][j]!r})*({text[j]})" for j in range(self.dim)))
        return out + [None] * (3 - self.dim)

    def rotation(self):
        """Rows of the rotation by `turn` about the model's axis (Rodrigues)."""
        n = math.sqrt(sum(c * c for c in self.about))
        u = [c / n for c in self.about]
        s, c = math.sin(self.turn), math.cos(self.turn)
        cross = [[0, -u[2], u[1]], [u[2], 0, -u[0]], [-u[1], u[0], 0]]
        return [[c * (i == j) + s * cross[i][j] + (1 - c) * u[i] * u[j] for j in range(3)] for i in range(3)]

    def direct(self, vector, back=False):
        if not self.turn:
            return list(vector)
        rows = self.rotation()
        v = list(vector) + [0.0] * (3 - len(vector))
        return [sum((rows[j][i] if back else rows[i][j]) * v[j] for j in range(3)) for i in range(3)]

    def traction(self, body, side, vector, time="t", where=None):
        """A traction on a side, times the function `time`: per area of the undeformed side, but of the present one about an axis."""
        size = math.sqrt(sum(c * c for c in vector))
        if size == 0.0:
            return
        axisymmetric = self.mesh.elements[body.elements[0] - 1][0].startswith("Axisym")
        family = "Line" if self.dim == 2 else "Surface"
        made = body.conditions(side, ("Axisym" if axisymmetric else "SmallDisplacement") + family + "Load", where)
        self.processes.append(("loads", process("assign_vector_by_direction_to_condition_process", {
            "model_part_name": "Structure." + self.part(self._nodes_of(made), made), "variable_name": family.upper() + "_LOAD",
            "modulus": f"({size * self.stress!r})*({time})", "direction": [c / size for c in self.direct(list(vector) + [0.0] * (3 - len(vector)))],
            "interval": [0.0, "End"]})))

    def pressure(self, body, side, value, time="t"):
        """A pressure on a side, which follows it."""
        axisymmetric = "Axisym" if self.mesh.elements[body.elements[0] - 1][0].startswith("Axisym") else ""
        made = body.conditions(side, axisymmetric + ("Line" if self.dim == 2 else "Surface") + "Load")
        self.processes.append(("loads", process("assign_scalar_variable_to_conditions_process", {
            "model_part_name": "Structure." + self.part(self._nodes_of(made), made), "variable_name": "POSITIVE_FACE_PRESSURE",
            "value": f"({(-value if self.dim == 2 else value) * self.stress!r})*({time})", "interval": [0.0, "End"]})))

    def point_load(self, nodes, vector, time="t"):
        """A force on each of some nodes."""
        size = math.sqrt(sum(c * c for c in vector))
        made = [self.mesh.add_condition(f"PointLoadCondition{self.dim}D1N", (i,)) for i in nodes]
        self.processes.append(("loads", process("assign_vector_by_direction_to_condition_process", {
            "model_part_name": "Structure." + self.part(nodes, made), "variable_name": "POINT_LOAD",
            "modulus": f"({size * self.force_scale!r})*({time})", "direction": [c / size for c in self.direct(list(vector) + [0.0] * (3 - len(vector)))],
            "interval": [0.0, "End"]})))

    def process(self, name, settings, kind="constraints"):
        """Any other process."""
        self.processes.append((kind, process(name, settings)))

    def rigid(self, nodes, variable="DISPLACEMENT"):
        """Nodes that move alike."""
        self.processes.append(("constraints", process("impose_rigid_movement_process", {
            "model_part_name": "Structure." + self.part(nodes), "master_variable_name": variable, "interval": [0.0, "End"]}, STRUCTURE)))

    def velocity(self, nodes, vector):
        for axis, value in zip("XYZ", self.direct(list(vector) + [0.0] * (3 - len(vector)))):
            if value:
                self.mesh.nodal_data.setdefault("VELOCITY_" + axis, {}).update({i: value * self.length for i in nodes})

    def _nodes_of(self, conditions):
        return {i for c in conditions for i in self.mesh.condition_list[c - 1][1]}

    # --- interfaces ---------------------------------------------------------------------------------------------------------

    def _facets(self, body, side, *where):
        """Conditions on a side of a body."""
        return body.conditions(side, "Line" if self.dim == 2 else "Surface", *where)

    def interface(self, slave, master):
        """A pair of sides, each a (body, side) or (body, side, where); `where` chooses facets by their middle."""
        return self.between(self._facets(*slave), self._facets(*master))

    def interface_with_shape(self, slave, tool, reference, **settings):
        """A pair of a side and a rigid shape, whose part and reference node are called so; what the contact process gets for it."""
        number = str(len(self.pairs))
        self.between(self._facets(*slave), [])
        interface, part = self.pairs[-1]
        self.process("rigid_shape_process", {"model_part_name": "Structure." + tool, "reference_model_part_name": "Structure." + reference,
            **settings})
        return {"contact_model_part": {number: [interface, tool]}, "assume_master_slave": {number: [part]}}

    def between(self, slave, master):
        """A pair of lists of conditions; returns the slave's nodes."""
        number, slaves = len(self.pairs), self._nodes_of(slave)
        self.mesh.part(f"Slave{number}", slaves, (), slave)
        self.mesh.part(f"Interface{number}", self._nodes_of(slave + master), (), slave + master)
        self.pairs.append((f"Interface{number}", f"Slave{number}"))
        self.watched[number] = sorted(slaves)
        return sorted(slaves)

    def contact(self, family, friction=None, **more):
        """The process of all interfaces by one family."""
        name, kind, _ = FAMILIES[family]
        made = contact_process(self.pairs, kind, **more)
        made["python_module"] = name
        settings = made["Parameters"]
        if family == "tie":
            settings["mesh_tying_model_part"] = settings.pop("contact_model_part")
            settings.pop("contact_type")
        if friction is not None:
            settings["friction_coefficients"] = {str(i): friction for i in range(len(self.pairs))}
        return made

    # --- the deck -----------------------------------------------------------------------------------------------------------

    def finished_mesh(self):
        """The mesh as written: turned, and in the deck's unit of length."""
        mesh = ExactMesh()
        mesh.__dict__.update(self.mesh.__dict__)
        mesh.nodes = {i: tuple(c * self.length for c in self.direct(p)) for i, p in self.mesh.nodes.items()}
        return mesh

    def deck(self, family, steps=1, time_step=None, friction=None, solver=None, settings=None, end=1.0, outputs=(), contact=None, dynamic=None):
        """ProjectParameters.json; `solver`, `settings` and `contact` are what the case itself asks for."""
        constraint = family.startswith("MPC")
        base = {"solver_type": "Dynamic" if dynamic is not None else "Static", "model_part_name": "Structure", "domain_size": self.dim,
                "model_import_settings": {"input_type": "mdpa", "input_filename": "mesh"},
                "material_import_settings": {"materials_filename": "StructuralMaterials.json"},
                "time_stepping": {"time_step": time_step or end / steps},
                "convergence_criterion": "residual_criterion" if constraint else "contact_residual_criterion",
                **(dynamic or {}), **(solver or {})}
        _, kind, mortar = FAMILIES[family]
        if self.pairs:
            base["mpc_contact_settings" if constraint else "contact_settings"] = {
                **({"contact_type": kind} if constraint else {"mortar_type": mortar}), **(settings or {})}
        else:
            base["convergence_criterion"] = "residual_criterion"
        lists = {"constraints": [], "loads": []}
        for kind, made in self.processes:
            lists[kind].append(made)
        contacts = [self.contact(family, friction, **(contact or {}))] if self.pairs else []
        project = parameters("mesh", base, lists["constraints"], lists["loads"], contacts, outputs, end)
        project["problem_data"]["end_time"] = end
        return project
