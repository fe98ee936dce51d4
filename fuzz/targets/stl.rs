#![no_main]

use libfuzzer_sys::fuzz_target;
use tessgraph_io::Format;

fuzz_target!(|bytes: &[u8]| tessgraph_fuzz::read_mesh(Format::Stl, bytes));
