#![no_main]

use libfuzzer_sys::fuzz_target;
use tessgraph_io::Format;

fuzz_target!(|bytes: &[u8]| {
    let format = if bytes.starts_with(b"glTF") {
        Format::Glb
    } else {
        Format::Gltf
    };
    tessgraph_fuzz::read_mesh(format, bytes);
});
