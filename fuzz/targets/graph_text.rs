#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| drop(tessgraph_fuzz::check_graph(bytes)));
