#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| zelus_fuzz::targets::forged(bytes));
