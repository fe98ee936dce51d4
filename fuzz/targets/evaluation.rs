#![no_main]

use libfuzzer_sys::arbitrary::Unstructured;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(text) = tessgraph_fuzz::random_graph(&mut Unstructured::new(bytes)) {
        tessgraph_fuzz::evaluate_graph(&text);
    }
});
