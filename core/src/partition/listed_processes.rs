//! The processes that a deck lists, with their requests to the partition.

use crate::parameters::{Node, Value};
use crate::processes::ProcessEntry;
use crate::registry;

/// Calls `see` with the entry and the parameters of every process listed below `node`.
pub(super) fn each_process(node: &Node, see: &mut impl FnMut(&'static ProcessEntry, Option<&Node>)) {
    match &node.value {
        Value::Array(items) => items.iter().for_each(|item| each_process(item, see)),
        Value::Object(members) => {
            let name = members.get("python_module").or(members.get("name")).and_then(Node::as_str);
            match name.and_then(|name| registry::find(name.rsplit('.').next().unwrap_or(name))) {
                Some(entry) => see(entry, members.get("Parameters")),
                None => members.iter().for_each(|member| each_process(&member.node, see)),
            }
        }
        _ => {}
    }
}
