//! Marks of the sides and states of contact.

use zelus_core::register_flags;

register_flags! {
    pub SLAVE = "On the side of a contact pair that carries the multipliers, as assume_master_slave of the process says; an output.";
    pub MASTER = "On the other side of a contact pair; an output.";
    pub SLIP = "A slave node that slides while it is in contact, or did so when it last was; undefined before; an output.";
    pub ISOLATED = "A slave node that faces no master, or too little of it (least_coverage): it is not in contact; an output.";
    pub CONTACT = "Part of a contact problem.";
}
