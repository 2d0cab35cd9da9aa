//! The entry of the materials file that each element has its material from.

use crate::diagnostics::Diagnostic;
use crate::model::{ModelPart, Properties};

/// The entries of a materials file by element; a later entry replaces an earlier one only where its part lies in that of the earlier,
/// by its path or with all of its elements.
pub(super) struct GivenMaterials {
    /// Entry of each element: its place among the entries, and the id of its properties.
    of_element: Vec<Option<(usize, usize)>>,
}

impl GivenMaterials {
    /// Nothing is given yet.
    pub fn new(part: &ModelPart) -> Self {
        Self { of_element: vec![None; part.elements.len()] }
    }

    /// Gives `elements` the properties `id` of the entry for the part `name`, which follows those for `earlier`. The problem that
    /// elements have another material from an entry for a part that does not hold this one.
    pub fn give(
        &mut self,
        elements: &[u32],
        earlier: &[String],
        name: &str,
        id: usize,
        part: &ModelPart,
    ) -> Option<Diagnostic> {
        let entry_of = |element: &u32| self.of_element[*element as usize].map(|(entry, _)| entry);
        let around =
            elements.first().and_then(entry_of).filter(|of| elements.iter().all(|at| entry_of(at) == Some(*of)));
        let mut contradictions: Vec<(u32, usize)> = Vec::new();
        for &element in elements {
            let before = self.of_element[element as usize].replace((earlier.len(), id));
            let lies_in = |entry: usize| around == Some(entry) || is_part_of(name, &earlier[entry]);
            let other = before.filter(|&(entry, _)| !lies_in(entry));
            let differs = |&(_, other): &(usize, usize)| match (part.properties.get(&other), part.properties.get(&id)) {
                (Some(one), Some(two)) => !is_same_material(one, two),
                _ => true,
            };
            contradictions.extend(other.filter(differs).map(|(entry, _)| (element, entry)));
        }
        let &(element, entry) = contradictions.first()?;
        let first = part.elements.ids[element as usize];
        let which = match contradictions.len() {
            1 => format!("element {first} is"),
            count => format!("{count} elements, the first is {first}, are"),
        };
        let fact = format!("{which} in the parts {:?} and {name:?}, which get different materials", earlier[entry]);
        let remedy = "take the elements out of one of the parts, or name a part inside the other after it";
        Some(Diagnostic::error("element-in-two-materials", fact).remedy(remedy))
    }
}

/// Whether two sets of properties differ in id and place at most.
fn is_same_material(one: &Properties, two: &Properties) -> bool {
    let without_name = |of: &Properties| Properties { id: 0, place: None, ..of.clone() };
    without_name(one) == without_name(two)
}

/// Whether the path `name` is that of `parent` or of a part below it.
pub(super) fn is_part_of(name: &str, parent: &str) -> bool {
    name.strip_prefix(parent).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}
