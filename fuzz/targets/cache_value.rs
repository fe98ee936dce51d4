#![no_main]

use libfuzzer_sys::fuzz_target;
use tessgraph_graph::Value;
use tessgraph_graph::value::encode::{Decoder, Encoder};

// What is decoded must be encoded to bytes that decode to the same again. The
// checksum that guards these bytes on disk is left out on purpose.
fuzz_target!(|bytes: &[u8]| {
    let mut from = Decoder::new(bytes, &|_| None);
    let Some(value) = Value::decode(&mut from) else {
        return;
    };
    let Some(value) = from.finish(value) else {
        return;
    };
    let mut out = Encoder::new();
    if value.encode(&mut out) {
        let (written, _) = out.finish();
        let mut from = Decoder::new(&written, &|_| None);
        let again = Value::decode(&mut from).expect("what was written is read");
        assert_eq!(again.digest(), value.digest());
    }
});
