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


def pyramids(order):
    """A layer of hexahedra under one of tetrahedra, with pyramids between them."""
    occ, mesh = gmsh.model.occ, gmsh.model.mesh
    for z in (0.0, 0.5):
        occ.addBox(0, 0, z, 1, 1, 0.5)
    occ.fragment([(3, 1)], [(3, 2)])
    occ.synchronize()
    for _, face in gmsh.model.getBoundary([(3, 1)], oriented=False):
        mesh.setTransfiniteSurface(face)
        mesh.setRecombine(2, face)
    for _, line in gmsh.model.getEntities(1):
        mesh.setTransfiniteCurve(line, 3)
    mesh.setTransfiniteVolume(1)
    gmsh.model.addPhysicalGroup(3, [1, 2], name="Body")
    skin = gmsh.model.getBoundary([(3, 1), (3, 2)], combined=True, oriented=False)
    gmsh.model.addPhysicalGroup(2, [face for _, face in skin], name="Skin")
    gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 1)
    mesh.generate(3)
    mesh.setOrder(order)


def prisms():
    """An oblique block of prisms of 18 nodes."""
    occ = gmsh.model.occ
    face = occ.addRectangle(0, 0, 0, 1, 1)
    occ.extrude([(2, face)], 0.2, 0, 0.8, numElements=[2], recombine=True)
    occ.synchronize()
    for _, line in gmsh.model.getEntities(1):
        gmsh.model.mesh.setTransfiniteCurve(line, 3)
    gmsh.model.addPhysicalGroup(3, [1], name="Body")
    gmsh.model.addPhysicalGroup(2, [tag for _, tag in gmsh.model.getEntities(2)], name="Skin")
    gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 0)
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.setOrder(2)


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


def save_one(name, make):
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    make()
    gmsh.write(f"{name}.msh")
    gmsh.finalize()


save("solids_1", lambda: solids(1))
save("solids_2", lambda: solids(2))
save("disc", disc)
save_one("pyramids_1", lambda: pyramids(1))
save_one("pyramids_2", lambda: pyramids(2))
save_one("prisms_18", prisms)
