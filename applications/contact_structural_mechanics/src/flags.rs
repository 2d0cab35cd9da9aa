//! Marks of the sides and states of contact.

use zelus_core::register_flags;

register_flags! {
    pub SLAVE = "On the side of a contact pair that carries the multipliers.";
    pub MASTER = "On the other side of a contact pair.";
    pub SLIP = "Slides.";
    pub ISOLATED = "A contact pair whose sides do not overlap.";
    pub CONTACT = "Part of a contact problem.";
}
