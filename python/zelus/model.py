"""The model of a run: parts with their nodes, elements and conditions."""

from __future__ import annotations

import numpy as np

from .entities import Condition, Container, Element, Node, ProcessInfo, Properties, PropertiesContainer


class Model:
    """All root model parts of a run. It is empty until a run reads its mesh."""

    def __init__(self):
        self._driving = None

    def _attach(self, driving):
        self._driving = driving

    @property
    def _session(self):
        if self._driving is None:
            raise RuntimeError("the model is empty: AnalysisStage.Initialize reads the mesh that the deck names")
        return self._driving.session

    def _check_changeable(self, what, where):
        if self._driving is not None and self._driving.is_set_up:
            raise RuntimeError(f"{what} are taken up once the stage is set up: change them in {where} of an AnalysisStage")

    def _root(self):
        root = self._session.root()
        if not root:
            raise RuntimeError("no mesh is read yet")
        return root

    def _time(self):
        return self._session.info(self._root(), "TIME")

    def _field(self, name):
        root = self._root()
        store = "history" if self._session.has_column(root, "history", name) else "nodes"
        return np.asarray(self._session.column(root, store, name, 0))

    def _path(self, name):
        """The full path of a part that may be named without its root."""
        roots = self._session.roots()
        if name.split(".")[0] in roots:
            return name
        found = [f"{root}.{path}" for root in roots for path in self._paths(root) if f".{path}".endswith(f".{name}")]
        if len(found) != 1:
            raise KeyError(f"there is no model part {name!r}; paths begin with the root part: {', '.join(roots)}")
        return found[0]

    def _paths(self, root):
        out = []
        for name in self._session.sub_parts(root):
            out.append(name)
            out += [f"{name}.{below}" for below in self._paths(f"{root}.{name}")]
        return out

    def GetModelPart(self, name):
        """The part of that path, e.g. "Structure.Top"."""
        path = self._path(name)
        self._session.sub_parts(path)
        return ModelPart(self, path)

    __getitem__ = GetModelPart

    def HasModelPart(self, name):
        """Whether there is a part of that path."""
        if self._driving is None:
            return False
        try:
            self.GetModelPart(name)
        except KeyError:
            return False
        return True

    def GetModelPartNames(self):
        """Full names of all parts."""
        return [name for root in self._session.roots() for name in [root, *(f"{root}.{p}" for p in self._paths(root))]]

    def CreateModelPart(self, name, _buffer=1):
        """Parts are read from the mesh that a deck names."""
        raise NotImplementedError(f"the part {name!r} cannot be made here: a deck's mesh file brings it")


class _Communicator:
    """Sums and extremes over the processes of a run, which is one."""

    def MyPID(self):
        """The number of the process."""
        return 0

    Rank = MyPID

    def TotalProcesses(self):
        """The number of processes."""
        return 1

    Size = TotalProcesses

    def IsDistributed(self):
        """Whether there are several."""
        return False

    def GetDataCommunicator(self):
        """Itself."""
        return self

    def _same(self, value, *_):
        return value

    SumAll = MaxAll = MinAll = Sum = Max = Min = Broadcast = _same

    def Barrier(self):
        """Waits for nobody."""


class ModelPart:
    """A part of the model, by its path."""

    def __init__(self, model, path):
        self._model, self._path = model, path

    def __eq__(self, other):
        return isinstance(other, ModelPart) and (self._model, self._path) == (other._model, other._path)

    def __hash__(self):
        return hash(self._path)

    def __str__(self):
        counts = f"{self.NumberOfNodes()} nodes, {self.NumberOfElements()} elements, {self.NumberOfConditions()} conditions"
        return f"{self._path}: {counts}"

    @property
    def _session(self):
        return self._model._session

    @property
    def _root(self):
        return self._path.split(".")[0]

    @property
    def Name(self):
        """Its own name."""
        return self._path.rsplit(".", 1)[-1]

    def FullName(self):
        """Its path."""
        return self._path

    def GetModel(self):
        """The model."""
        return self._model

    def GetRootModelPart(self):
        """The part that its path begins with."""
        return ModelPart(self._model, self._root)

    def GetParentModelPart(self):
        """The part it is of; itself for a root."""
        return ModelPart(self._model, self._path.rsplit(".", 1)[0])

    def IsSubModelPart(self):
        """Whether it is part of another."""
        return "." in self._path

    def GetSubModelPart(self, name):
        """The part of that name below this one."""
        self._session.sub_parts(f"{self._path}.{name}")
        return ModelPart(self._model, f"{self._path}.{name}")

    def HasSubModelPart(self, name):
        """Whether there is a part of that name below this one."""
        first, *more = name.split(".", 1)
        is_there = first in self._session.sub_parts(self._path)
        return is_there and (not more or self.GetSubModelPart(first).HasSubModelPart(more[0]))

    @property
    def SubModelParts(self):
        """The parts below it."""
        return [self.GetSubModelPart(name) for name in self._session.sub_parts(self._path)]

    def GetSubModelPartNames(self):
        """Names of the parts below it."""
        return self._session.sub_parts(self._path)

    def NumberOfSubModelParts(self):
        """How many parts are below it."""
        return len(self._session.sub_parts(self._path))

    def CreateSubModelPart(self, name):
        """Adds an empty part below it."""
        self._session.create_part(self._path, name)
        return self.GetSubModelPart(name)

    @property
    def Nodes(self):
        """Its nodes, by ascending id."""
        return Container(self, "nodes", Node)

    @property
    def Elements(self):
        """Its elements."""
        return Container(self, "elements", Element)

    @property
    def Conditions(self):
        """Its conditions."""
        return Container(self, "conditions", Condition)

    def GetNodes(self):
        """Its nodes."""
        return self.Nodes

    def GetElements(self):
        """Its elements."""
        return self.Elements

    def GetConditions(self):
        """Its conditions."""
        return self.Conditions

    def GetNode(self, id, _mesh=0):
        """The node of that id."""
        return self.Nodes[id]

    def GetElement(self, id, _mesh=0):
        """The element of that id."""
        return self.Elements[id]

    def GetCondition(self, id, _mesh=0):
        """The condition of that id."""
        return self.Conditions[id]

    def HasNode(self, id):
        """Whether it has the node of that id."""
        return id in self.Nodes

    def NumberOfNodes(self, _mesh=0):
        """How many nodes it has."""
        return len(self.Nodes)

    def NumberOfElements(self, _mesh=0):
        """How many elements it has."""
        return len(self.Elements)

    def NumberOfConditions(self, _mesh=0):
        """How many conditions it has."""
        return len(self.Conditions)

    def _add(self, kind, ids):
        root = self.GetRootModelPart()
        indices = [Container(root, kind, None)._index(int(id)) for id in ids]
        self._session.add_items(self._path, kind, indices)

    def AddNodes(self, ids):
        """Adds nodes of the root by their ids, here and to the parts above."""
        self._add("nodes", ids)

    def AddElements(self, ids):
        """Adds elements of the root by their ids, here and to the parts above."""
        self._add("elements", ids)

    def AddConditions(self, ids):
        """Adds conditions of the root by their ids, here and to the parts above."""
        self._add("conditions", ids)

    def AddNode(self, node, _mesh=0):
        """Adds a node of the root."""
        self._add("nodes", [node.Id])

    @property
    def ProcessInfo(self):
        """Time, counters and named numbers."""
        return ProcessInfo(self)

    @property
    def Properties(self):
        """All properties."""
        return PropertiesContainer(self)

    def GetProperties(self, id=None, _mesh=0):
        """All properties, or those of that id."""
        return self.Properties if id is None else Properties(self, id)

    def HasProperties(self, id):
        """Whether there are properties of that id."""
        return id in self._session.properties(self._path)

    def HasNodalSolutionStepVariable(self, variable):
        """Whether nodes have this variable with history."""
        return self._session.has_column(self._path, "history", str(variable))

    def AddNodalSolutionStepVariable(self, variable):
        """Gives nodes this variable with history."""
        self._session.add_column(self._path, str(variable))

    def GetBufferSize(self):
        """How many steps are remembered, the present one included."""
        return self._session.levels(self._path)

    def GetCommunicator(self):
        """Sums and extremes over processes."""
        return _Communicator()

    def IsDistributed(self):
        """Whether several ranks share it."""
        return False

    def array(self, variable, step=0, *, historical=True):
        """A copy of a nodal variable, one row a node of this part."""
        whole = np.asarray(self._session.column(self._path, "history" if historical else "nodes", str(variable), step))
        return whole[np.asarray(self._session.items(self._path, "nodes"))]

    def set_array(self, variable, values, step=0, *, historical=True):
        """Writes a nodal variable, one row a node of this part."""
        store = "history" if historical else "nodes"
        whole = np.asarray(self._session.column(self._path, store, str(variable), step))
        whole[np.asarray(self._session.items(self._path, "nodes"))] = values
        self._session.set_column(self._path, store, str(variable), step, whole.tobytes())

    def positions(self, *, initial=False):
        """Positions of its nodes, one row each."""
        return np.asarray(self._session.positions(self._path, initial))[np.asarray(self._session.items(self._path, "nodes"))]
