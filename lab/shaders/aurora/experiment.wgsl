#define_import_path lensrunner_lab::aurora::experiment

// What the walks and the splats of the aurora's experiment share (lab/src/aurora): lengths in km in the axes of the patch, x east, y north,
// z up, or in r_s where light is bent. Filled by lab/src/aurora/race.rs.

struct Experiment {
    /// Flat: the camera's place. Bent: that of the patch from the camera, w: the image order.
    origin: vec4<f32>,
    /// From km in the patch's axes to the offset from the camera, columns.
    place: array<vec4<f32>, 3>,
    /// From there to right, up and back of the camera, columns.
    axes: array<vec4<f32>, 3>,
    /// Two unit vectors across the field.
    across: array<vec4<f32>, 2>,
    /// The same as the camera sees them.
    across_seen: array<vec4<f32>, 2>,
    /// Half the picture's sides in pixels, focal length in pixels, length of a km in the unit of apparent places.
    screen: vec4<f32>,
    /// x: nearest depth, y: standard deviation of a point's light in km, z: height of the lattice's lower end in km, w unused.
    various: vec4<f32>,
    /// x, y: low corner of the lattice, z, w: its cells per km.
    lattice: vec4<f32>,
    /// x, y, z: cells of the lattice, w: which random numbers.
    cells: vec4<u32>,
};

struct Electron {
    /// xyz: its field line at the top, w: where it stops, km.
    top: vec4<f32>,
    /// xyz: its field line where it stops, w: its collisions.
    end: vec4<f32>,
    /// x: row of the table of falls, y: its number.
    numbers: vec4<u32>,
};

const LEVELS: u32 = 160u;
const TOP: f32 = 420.0;
