//! The sub parts in which decks find the interface.

use zelus_core::model::{ModelPart, SubPart};

use super::facets::Interface;

/// Adds the part `Contact` with one `ContactSub<key>` an interface.
pub fn add_contact_part(part: &mut ModelPart, interfaces: &[Interface]) {
    let mut contact = SubPart::new("Contact");
    for interface in interfaces {
        let name = format!("ContactSub{}", interface.key);
        let child = SubPart { nodes: interface.nodes.clone(), ..SubPart::new(name.clone()) };
        contact.nodes.extend(&interface.nodes);
        contact.children.insert(name, child);
    }
    contact.normalise();
    part.tree.children.insert(contact.name.clone(), contact);
}
