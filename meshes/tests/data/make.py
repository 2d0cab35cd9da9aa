"""Makes the meshes of this folder with Gmsh's own Python package (`pip install gmsh`)."""

import gmsh


def solids(order):
    """A cube of tetrahedra, one of hexahedra above it, one of prisms above that, each 1 x 1 x 1, with gaps of 0.01."""
    occ = gmsh.model.occ
    occ.addBox(0, 0, 0, 1, 1, 1)
    for x, recombine, z in [(0, True, 1.01), (0, False, 2.02)]:
        face = occ.addRectangle(x, 0, z, 1, 1)
        occ.synchronize()
        gmsh.model.mesh.setTransfiniteSurface(face)
        if recombine:
            gmsh.model.mesh.setRecombine(2, face)
        for _, line in gmsh.model.getBoundary([(2, face)], oriented=False):
            gmsh.model.mesh.setTransfiniteCurve(line, 3)
        occ.extrude([(2, face)], 0, 0, 1, numElements=[2], recombine=True)
    occ.synchronize()
    for name, (_, volume) in zip(["Tets", "Hexes", "Prisms"], gmsh.model.getEntities(3)):
        gmsh.model.addPhysicalGroup(3, [volume], name=name)

    def at(z):
        box = gmsh.model.getEntitiesInBoundingBox(-1, -1, z - 1e-3, 2, 2, z + 1e-3, 2)
        return [tag for _, tag in box]

    gmsh.model.addPhysicalGroup(2, at(0.0), name="Bottom")
    gmsh.model.addPhysicalGroup(2, at(3.02), name="Top")
    gmsh.model.addPhysicalGroup(0, [1], name="Corner")
    gmsh.option.setNumber("Mesh.MeshSizeMax", 1.0)
    gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 1)
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.setOrder(order)


def disc():
    """A disc of radius 1 in quadrilaterals of nine nodes and triangles of six, without groups."""
    occ = gmsh.model.occ
    occ.addDisk(0, 0, 0, 1, 1)
    occ.addRectangle(2, 0, 0, 1, 1)
    occ.synchronize()
    gmsh.model.mesh.setTransfiniteSurface(2)
    gmsh.model.mesh.setRecombine(2, 2)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.5)
    gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 0)
    gmsh.model.mesh.generate(2)
    gmsh.model.mesh.setOrder(2)


def save(name, make):
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    make()
    for version, binary, tag in [(2.2, 0, "22"), (2.2, 1, "22b"), (4.1, 0, "41"), (4.1, 1, "41b")]:
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.option.setNumber("Mesh.Binary", binary)
        gmsh.write(f"{name}_{tag}.msh")
    gmsh.option.setNumber("Mesh.Binary", 0)
    gmsh.write(f"{name}.inp")
    if name.startswith("solids"):
        gmsh.write(f"{name}.med")
    gmsh.finalize()


save("solids_1", lambda: solids(1))
save("solids_2", lambda: solids(2))
save("disc", disc)
