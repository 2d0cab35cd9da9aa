//! Fields that JSON leaves out where they are nothing. A saved run holds all fields of a type, since nothing there names them.

use serde::ser::{Error, Serialize, Serializer};
use serde_json::Value;

/// Serde's traits for a type with the attribute `#[serde(remote = "Self")]`: JSON leaves out these fields where they are nothing.
macro_rules! omitted_from_json {
    ($type:ty, $($field:literal),+) => {
        impl ::serde::Serialize for $type {
            fn serialize<S: ::serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                if !serializer.is_human_readable() {
                    return <$type>::serialize(self, serializer);
                }
                let json = <$type>::serialize(self, ::serde_json::value::Serializer);
                $crate::strategies::omitted_fields::write_without(json, &[$($field),+], serializer)
            }
        }

        impl<'de> ::serde::Deserialize<'de> for $type {
            fn deserialize<D: ::serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                <$type>::deserialize(deserializer)
            }
        }
    };
}

pub(super) use omitted_from_json;

/// Writes an object, without those of the fields that are nothing.
pub(super) fn write_without<S: Serializer>(
    json: serde_json::Result<Value>,
    fields: &[&str],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let mut json = json.map_err(S::Error::custom)?;
    if let Some(all) = json.as_object_mut() {
        all.retain(|name, value| !(value.is_null() && fields.contains(&name.as_str())));
    }
    json.serialize(serializer)
}

#[cfg(test)]
mod tests {
    use crate::packed;
    use crate::strategies::{Balance, Flows, IterationRecord, StepRecord, UnknownBalance};

    fn records() -> [StepRecord; 2] {
        let iteration = IterationRecord {
            iteration: 1,
            checks: Vec::new(),
            active_set_changes: 0,
            stick_slip_changes: 0,
            changed_nodes: vec![7],
            linear_residual: f64::INFINITY,
            linear_iterations: 3,
            engine: "direct".to_owned(),
            condition_number: None,
        };
        let known = IterationRecord { condition_number: Some(2.5), ..iteration.clone() };
        let flows = UnknownBalance { flows: Some(Flows::default()), ..UnknownBalance::default() };
        let balance = Balance { unknowns: vec![UnknownBalance::default(), flows], ..Balance::default() };
        let first =
            StepRecord { step: 1, time: 0.1 + 0.2, iterations: vec![iteration, known], ..StepRecord::default() };
        [StepRecord { balance: Some(balance), ..first.clone() }, first]
    }

    #[test]
    fn saved_runs_hold_what_json_leaves_out() {
        let records = records();
        let read: [StepRecord; 2] = packed::from_bytes(&packed::to_bytes(&records).unwrap()).unwrap();
        assert_eq!(read, records);
        let json = serde_json::to_string(&records).unwrap();
        let count = |field: &str| json.matches(&format!("\"{field}\":")).count();
        assert_eq!([count("condition_number"), count("flows"), count("balance")], [2, 1, 1], "{json}");
        assert!(json.contains("\"time\":0.30000000000000004,") && json.contains("\"failure\":null"), "{json}");
        assert!(json.starts_with("[{\"step\":1,\"time\"") && json.ends_with("\"interactions\":[]}]"), "{json}");
    }

    #[test]
    fn records_are_read_from_json_that_leaves_fields_out() {
        let [mut record, _] = records();
        record.iterations.iter_mut().for_each(|iteration| iteration.linear_residual = 1e-9);
        let json = serde_json::to_string(&record).unwrap();
        assert_eq!(serde_json::from_str::<StepRecord>(&json).unwrap(), record);
    }
}
