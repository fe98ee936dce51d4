//! Even thickness: the add-on's is to be beaten, not reproduced.

use tessgraph_geometry::surface::Surface;
use tessgraph_geometry::{Mesh, Unmonitored};

use super::case::Verdict;
use crate::support::{Ran, height_errors};

/// Beaten if every vertex of ours has a solution and both sides keep their
/// thickness better, measured with borders continued.
pub(super) fn judge(ran: &Ran, theirs: &Mesh) -> Verdict {
    let unsolved = ran.number("apart.unsolved");
    if unsolved > 0.0 {
        return Verdict::Differs(format!("{unsolved} vertices have no solution"));
    }
    let ours = ran.mesh("result");
    if ours.vertex_count() != theirs.vertex_count() {
        return Verdict::Differs("other counts".to_owned());
    }
    let base = Surface::new(&ran.mesh("base"), &Unmonitored).expect("a base with faces");
    let component = ran.mesh("component");
    let mut said = Vec::new();
    let mut better = true;
    for (name, sign) in [("top", 1.0), ("bottom", -1.0)] {
        let [here, there] =
            [&ours, theirs].map(|mesh| height_errors(mesh, &base, &component, sign));
        better &= here.max <= there.max && here.rms <= there.rms;
        said.push(format!(
            "{name} {:.4} % rms and {:.4} % at most, theirs {:.4} % and {:.4} %",
            here.rms * 100.0,
            here.max * 100.0,
            there.rms * 100.0,
            there.max * 100.0
        ));
    }
    if better {
        Verdict::Beaten(said.join("; "))
    } else {
        Verdict::Differs(said.join("; "))
    }
}
