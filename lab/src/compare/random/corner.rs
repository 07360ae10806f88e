//! Where scenes are drawn from.

/// Where a case was drawn from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Corner {
    /// Anywhere.
    Open,
    /// Things on the line through camera and hole, or beside it by less than their size, behind the hole.
    Axis,
    /// The camera at r = 3/2 or close to it.
    PhotonSphere,
    /// The camera or the things just outside or inside of the horizon.
    Horizon,
    /// Ships at up to 0.99 c.
    Fast,
    /// Spheres of thousands of triangles on the axis.
    Small,
    /// Several things on the axis, whose rings cross, or of which one hides its own second image.
    Rings,
    /// The camera within a ball.
    Within,
    /// A planet behind the hole, beyond the disk.
    Planet,
}

impl Corner {
    /// All of them.
    pub const ALL: [Corner; 9] = [
        Corner::Open,
        Corner::Axis,
        Corner::PhotonSphere,
        Corner::Horizon,
        Corner::Fast,
        Corner::Small,
        Corner::Rings,
        Corner::Within,
        Corner::Planet,
    ];

    /// A word for tables.
    pub fn word(self) -> &'static str {
        match self {
            Corner::Open => "open",
            Corner::Axis => "axis",
            Corner::PhotonSphere => "photon-sphere",
            Corner::Horizon => "horizon",
            Corner::Fast => "fast",
            Corner::Small => "small-triangles",
            Corner::Rings => "rings",
            Corner::Within => "within",
            Corner::Planet => "planet",
        }
    }
}
