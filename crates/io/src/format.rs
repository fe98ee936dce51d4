//! Which formats there are, and how a file name chooses one.

use std::fmt;

/// A file format that meshes are read from or written to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Format {
    /// Wavefront OBJ.
    Obj,
    /// Binary glTF 2.0: one file.
    Glb,
    /// glTF 2.0 as JSON with buffers beside or inside it; read only.
    Gltf,
    /// STL, binary or ASCII.
    Stl,
    /// PLY (Stanford), binary or ASCII.
    Ply,
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 5] = [Self::Obj, Self::Glb, Self::Gltf, Self::Stl, Self::Ply];

    /// The format a file name's extension chooses, in any case of letters.
    ///
    /// ```
    /// use tessgraph_io::Format;
    /// assert_eq!(Format::from_name("meshes/Roof.OBJ"), Some(Format::Obj));
    /// assert_eq!(Format::from_name("roof.dwg"), None);
    /// ```
    pub fn from_name(name: &str) -> Option<Self> {
        let file = name.rsplit(['/', '\\']).next().unwrap_or(name);
        let (_, extension) = file.rsplit_once('.')?;
        Self::ALL
            .into_iter()
            .find(|format| extension.eq_ignore_ascii_case(format.extension()))
    }

    /// The file name extension, in lower case and without the point.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Obj => "obj",
            Self::Glb => "glb",
            Self::Gltf => "gltf",
            Self::Stl => "stl",
            Self::Ply => "ply",
        }
    }

    /// Whether lengths are metres by specification (glTF); the other formats
    /// carry no unit.
    pub fn is_metric(self) -> bool {
        matches!(self, Self::Glb | Self::Gltf)
    }

    /// Whether meshes can be written in this format.
    pub fn is_writable(self) -> bool {
        self != Self::Gltf
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Obj => "OBJ",
            Self::Glb => "GLB",
            Self::Gltf => "glTF",
            Self::Stl => "STL",
            Self::Ply => "PLY",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extension_alone_decides() {
        assert_eq!(Format::from_name("a.tar.GLB"), Some(Format::Glb));
        assert_eq!(Format::from_name("x.gltf"), Some(Format::Gltf));
        assert_eq!(Format::from_name("dir.obj/readme"), None);
        assert_eq!(Format::from_name("obj"), None);
    }
}
