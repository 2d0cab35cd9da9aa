//! The elements behind slave facets, which give the traction on them.

use rustc_hash::FxHashMap;
use zelus_core::Result;
use zelus_core::diagnostics::Diagnostic;
use zelus_core::entities::{BlockRequest, EntityBlock, EntityError, FacePoint, StepView, Tangent, block_factory};
use zelus_core::geometry::mapping::domain_size;
use zelus_core::geometry::{FacetShape, Nodal, combine};
use zelus_core::model::{EntityKind, ModelPart};
use zelus_core::vector3::{dot, norm, sub};
use zelus_structural_mechanics::variables::DISPLACEMENT;

use super::facet::{Facet, Roles};
use super::facets::Interface;
use crate::law::SlaveFace;
use crate::mortar::inner_point;

/// Share of the size of an element by which it is moved for second derivatives.
const STEP: f64 = 1e-5;

/// The elements behind slave facets; none for formulations with tractions of their own.
#[derive(Default)]
pub struct Bodies {
    blocks: Vec<Box<dyn EntityBlock>>,
    faces: FxHashMap<[u32; 2], SlaveElementFace>,
    /// Divisor of the weights of points about an axis.
    thickness: f64,
}

/// A slave facet as a face of its element.
struct SlaveElementFace {
    block: usize,
    at: usize,
    points: Vec<FacePoint>,
    densities: Vec<f64>,
    stiffness: f64,
    /// Length by which the element is moved for second derivatives.
    step: f64,
}

/// Tractions of the initial area at the inner points of a facet (force per area).
pub struct Tractions {
    /// The tractions.
    pub values: Nodal<[f64; 3]>,
    /// Their derivatives by the unknowns of the element, inner point by inner point.
    pub by: Vec<[f64; 3]>,
}

impl Bodies {
    /// The elements behind all facets that are slaves or may become slaves; `thickness` is that about an axis.
    ///
    /// # Errors
    /// Elements that have no tractions.
    pub fn new(part: &ModelPart, interfaces: &[Interface], axisymmetric: Option<f64>) -> Result<Self> {
        let mut slaves: Vec<([u32; 2], &Facet)> = Vec::new();
        for (at, interface) in interfaces.iter().enumerate() {
            let facets = interface.facets.iter().enumerate();
            let may_be_slave = facets.filter(|(_, facet)| interface.open || facet.role == Roles::Slave);
            slaves.extend(may_be_slave.map(|(facet, own)| ([at as u32, facet as u32], own)));
        }
        let mut elements: Vec<u32> = slaves.iter().map(|(_, facet)| facet.element).collect();
        elements.sort_unstable_by_key(|&element| (part.elements.kinds[element as usize].name, element));
        elements.dedup();
        let mut bodies = Self { thickness: axisymmetric.unwrap_or(1.0), ..Self::default() };
        let mut places = FxHashMap::default();
        for members in elements.chunk_by(|a, b| kind(part, *a).name == kind(part, *b).name) {
            let entry = kind(part, members[0]);
            let Some(make) = block_factory(entry) else {
                return Err(lack(part, members[0], "it has no stresses").into());
            };
            let members = members.to_vec();
            places.extend(members.iter().enumerate().map(|(at, &element)| (element, (bodies.blocks.len(), at))));
            let request =
                BlockRequest { entry, members, table: &part.elements, nodes: &part.nodes, part, on_initial: false };
            let mut block = make(&request)?;
            block.initialize(&part.view())?;
            bodies.blocks.push(block);
        }
        for (key, facet) in slaves {
            let (block, at) = places[&facet.element];
            let own = &bodies.blocks[block];
            if let Some(why) = own.lacks_tractions(&part.view(), at) {
                return Err(lack(part, facet.element, why).into());
            }
            let face = SlaveElementFace::new(part, facet, own.as_ref(), (block, at), axisymmetric.is_some())?;
            bodies.faces.insert(key, face);
        }
        Ok(bodies)
    }

    fn face(&self, key: [u32; 2]) -> (&SlaveElementFace, &dyn EntityBlock) {
        let face = &self.faces[&key];
        (face, self.blocks[face.block].as_ref())
    }

    /// Nodes of the element behind a facet; none for formulations without.
    pub fn nodes(&self, key: [u32; 2]) -> &[u32] {
        self.faces.get(&key).map_or(&[], |face| self.blocks[face.block].nodes(face.at))
    }

    /// The unknowns of the element behind a facet: node index and component of the displacement.
    pub fn unknowns(&self, key: [u32; 2]) -> Vec<(u32, usize)> {
        let (face, block) = self.face(key);
        let nodes = block.nodes(face.at);
        block.unknowns().iter().map(|u| (nodes[u.node as usize], u.variable.offset())).collect()
    }

    /// The face behind a facet.
    pub fn slave_face(&self, key: [u32; 2]) -> SlaveFace {
        let (face, _) = self.face(key);
        let densities = Nodal::of(&face.densities);
        SlaveFace { densities, stiffness: face.stiffness, thickness: self.thickness }
    }

    /// Tractions at the inner points of a facet, with derivatives where they are `wanted`.
    ///
    /// # Errors
    /// An inverted element.
    pub fn tractions(&self, key: [u32; 2], view: &StepView<'_>, wanted: bool) -> Result<Tractions, EntityError> {
        let (face, block) = self.face(key);
        self.tractions_at(face, block, view, &displacements(block.nodes(face.at), view), wanted)
    }

    fn tractions_at(
        &self,
        face: &SlaveElementFace,
        block: &dyn EntityBlock,
        view: &StepView<'_>,
        u: &[[f64; 3]],
        wanted: bool,
    ) -> Result<Tractions, EntityError> {
        let size = block.unknowns().len();
        let count = face.points.len();
        let mut values = Nodal::new(count, |_| [0.0; 3]);
        let mut by = vec![[0.0; 3]; if wanted { count * size } else { 0 }];
        for (g, point) in face.points.iter().enumerate() {
            let by = wanted.then(|| &mut by[g * size..(g + 1) * size]);
            values[g] = block.traction(view, face.at, point, u, by)?;
        }
        Ok(Tractions { values, by })
    }

    /// Adds the second derivative of Σ wᵍ·tᵍ by the unknowns of the element, row by row: differences of the first one, which
    /// laws do not give the derivative of. Linear tractions have none.
    ///
    /// # Errors
    /// An inverted element.
    pub fn add_second_derivative(
        &self,
        key: [u32; 2],
        view: &StepView<'_>,
        weights: &[[f64; 3]],
        mut add: impl FnMut(usize, usize, f64),
    ) -> Result<(), EntityError> {
        let (face, block) = self.face(key);
        if block.tangent() == Tangent::Constant {
            return Ok(());
        }
        let mut u = displacements(block.nodes(face.at), view);
        let unknowns = block.unknowns();
        let size = unknowns.len();
        for (column, unknown) in unknowns.iter().enumerate() {
            let (node, c) = (unknown.node as usize, unknown.variable.offset());
            let here = u[node][c];
            for sign in [1.0, -1.0] {
                u[node][c] = here + sign * face.step;
                let moved = self.tractions_at(face, block, view, &u, true)?;
                for row in 0..size {
                    let work: f64 = (0..weights.len()).map(|g| dot(weights[g], moved.by[g * size + row])).sum();
                    add(row, column, sign * work / (2.0 * face.step));
                }
            }
            u[node][c] = here;
        }
        Ok(())
    }

    /// Least and largest M A/V of the faces; none without.
    pub fn stiffness(&self) -> Option<[f64; 2]> {
        let mut all = self.faces.values().map(|face| face.stiffness * self.thickness);
        let first = all.next()?;
        Some(all.fold([first; 2], |[least, most], one| [least.min(one), most.max(one)]))
    }
}

impl SlaveElementFace {
    fn new(
        part: &ModelPart,
        facet: &Facet,
        block: &dyn EntityBlock,
        (of_block, at): (usize, usize),
        axisymmetric: bool,
    ) -> Result<Self> {
        let shape = FacetShape::of(facet.shape).expect("facets of contact are lines and surfaces");
        let nodes = block.nodes(at);
        let cell = kind(part, facet.element).cell.expect("elements with faces have a cell").cell();
        let corners = shape.nodal(|j| {
            let place = nodes.iter().position(|node| *node == facet.nodes[j]).expect("a face of the element");
            cell.points[place]
        });
        let x = shape.nodal(|j| part.nodes.initial[facet.nodes[j] as usize]);
        let (mut points, mut densities) = (Vec::with_capacity(shape.nodes), Vec::with_capacity(shape.nodes));
        for g in 0..shape.nodes {
            let xi = inner_point(shape, g);
            let n = shape.values(xi);
            let local = combine(&n, &corners);
            points.push(FacePoint { local, normal: shape.unit_normal(&x, xi) });
            let radius = if axisymmetric { combine(&n, &x)[0] } else { 1.0 };
            densities.push(norm(shape.area_normal(&x, xi)) * radius);
        }
        let places: Vec<[f64; 3]> = nodes.iter().map(|&node| part.nodes.initial[node as usize]).collect();
        let by_depth = domain_size(facet.shape, &x) / domain_size(cell.shape, &places);
        let mut by = vec![[0.0; 3]; block.unknowns().len()];
        let rest = vec![[0.0; 3]; nodes.len()];
        let mut across = 0.0_f64;
        for point in &points {
            block.traction(&part.view(), at, point, &rest, Some(&mut by))?;
            // Under u = N N·x.
            let stretched = block.unknowns().iter().zip(&by).map(|(unknown, by)| {
                let along = dot(point.normal, sub(places[unknown.node as usize], x[0]));
                dot(*by, point.normal) * point.normal[unknown.variable.offset()] * along
            });
            across = across.max(stretched.sum());
        }
        // Factor of the trace inequality of linear stress over that of constant stress.
        let space = shape.space as f64;
        let by_degree = if shape.curved { 2.0 * (space + 1.0) / space } else { 1.0 };
        let size = places.iter().flat_map(|a| places.iter().map(|b| norm(sub(*a, *b))));
        let step = STEP * size.fold(0.0, f64::max);
        Ok(Self { block: of_block, at, points, densities, stiffness: across * by_depth * by_degree, step })
    }
}

fn kind(part: &ModelPart, element: u32) -> &'static EntityKind {
    part.elements.kinds[element as usize]
}

fn displacements(nodes: &[u32], view: &StepView<'_>) -> Vec<[f64; 3]> {
    let column = view.nodes.history.values(&DISPLACEMENT, 0);
    nodes.iter().map(|&node| std::array::from_fn(|c| column[3 * node as usize + c])).collect()
}

fn lack(part: &ModelPart, element: u32, why: &str) -> Diagnostic {
    let (id, name) = (part.elements.ids[element as usize], kind(part, element).name);
    let fact = format!("Nitsche's method needs tractions on the slave side, and element {id} ({name}) has none: {why}");
    Diagnostic::error("no-tractions", fact)
        .remedy("let the other body be the slave, or use alm_contact_process, whose multipliers need no stresses")
}
