//! The fields of [`GameConfig`]: each said once, with type, default, allowed range, unit and a line of help. The macro makes of
//! this the structs, their defaults and the table that the file reader and the dev overlay work from.

use super::setting::{Allowed, Setting, Value};
use crate::lensing::methods::NAMES;

const fn number(min: f64, max: f64) -> Allowed {
    Allowed::Number { min, max }
}

const fn integer(min: u32, max: u32) -> Allowed {
    Allowed::Integer { min, max }
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Value::Number(number)
    }
}

impl From<u32> for Value {
    fn from(number: u32) -> Self {
        Value::Integer(number)
    }
}

impl From<bool> for Value {
    fn from(on: bool) -> Self {
        Value::Switch(on)
    }
}

impl From<String> for Value {
    fn from(word: String) -> Self {
        Value::Word(word)
    }
}

/// Takes a checked value into a field; one of another type cannot come here and changes nothing.
trait Take {
    fn take(&mut self, value: Value);
}

macro_rules! take {
    ($type:ty, $variant:ident) => {
        impl Take for $type {
            fn take(&mut self, value: Value) {
                if let Value::$variant(value) = value {
                    *self = value;
                }
            }
        }
    };
}
take!(f64, Number);
take!(u32, Integer);
take!(bool, Switch);
take!(String, Word);

macro_rules! config {
    ($($(#[$about:meta])* $section:ident: $struct:ident {
        $($key:ident: $type:ty = $default:expr, $allowed:expr, $unit:literal, $help:literal;)*
    })*) => {
        /// Every tunable value of the game, by section of `game.toml`.
        #[derive(Debug, Clone, PartialEq, Default)]
        pub struct GameConfig {
            $($(#[$about])* pub $section: $struct,)*
        }

        $(
            $(#[$about])*
            #[derive(Debug, Clone, PartialEq)]
            pub struct $struct {
                $(#[doc = concat!($help, " (", $unit, ")")] pub $key: $type,)*
            }

            impl Default for $struct {
                fn default() -> Self {
                    Self { $($key: $default.into(),)* }
                }
            }
        )*

        /// Every setting, in the order of the file.
        pub fn settings() -> &'static [Setting<GameConfig>] {
            const SETTINGS: &[Setting<GameConfig>] = &[$($(
                Setting {
                    section: stringify!($section),
                    key: stringify!($key),
                    unit: $unit,
                    help: $help,
                    allowed: $allowed,
                    get: |config| config.$section.$key.clone().into(),
                    set: |config, value| config.$section.$key.take(value),
                },
            )*)*];
            SETTINGS
        }
    };
}

/// The setting with this dotted path, such as `render.orders`.
pub fn setting(path: &str) -> Option<&'static Setting<GameConfig>> {
    let (section, key) = path.split_once('.')?;
    settings().iter().find(|setting| setting.section == section && setting.key == key)
}

use Allowed::{Buttons, Choice, Switch, Words};

/// The actions that may be switched with a tap instead of held.
pub const HELD: &[&str] = &[
    "thrust_forward", "thrust_back", "thrust_left", "thrust_right", "thrust_up", "thrust_down", "boost", "fire", "pitch_up", "pitch_down",
    "yaw_left", "yaw_right", "roll_left", "roll_right", "look_at_target", "face_target",
];

config! {
    /// The hole.
    hole: Hole {
        mass_solar: f64 = 1e10, number(1.0, 1e12), "solar masses", "mass of the hole: what the HUD and the disk's temperature convert by";
    }
    /// How time runs.
    clock: Clock {
        pace: f64 = 1.5, number(0.01, 50.0), "r_s/c per second", "game time T that passes in a second before the screen";
        step: f64 = 0.03125, number(0.0005, 0.5), "r_s/c", "fixed step of the simulation";
        slow_near_danger: bool = true, Switch, "", "by hand: slower by itself where ships meet or one falls deep";
        max_steps: u32 = 200u32, integer(1, 10000), "steps", "most steps in one frame; beyond it the game slows down";
    }
    /// The picture.
    render: Render {
        pixel_error_budget: f64 = 0.5, number(0.05, 16.0), "pixels", "largest displacement allowed when a cheaper model is chosen";
        orders: u32 = 2u32, integer(1, 3), "images", "image orders drawn";
        method: String = "table", Choice(&NAMES), "", "how a vertex is projected";
        tessellation_max_level: u32 = 13u32, integer(0, 13), "halvings", "finest subdivision of an edge";
        vertex_budget: u32 = 1_200_000u32, integer(1_000, 2_000_000), "vertices", "room for tessellated vertices in a frame";
        min_width: f64 = 1.0, number(0.0, 4.0), "pixels", "thinner triangles of thin images are drawn this wide, with their coverage as alpha; 0 turns that off";
        thin_below: f64 = 2.0, number(0.0, 100.0), "pixels", "images narrower than this are thin ones";
        coarse_below: f64 = 0.0, number(0.0, 100.0), "pixels", "images narrower than this show a coarse stand-in, which is off by more than the error budget";
        least_width: f64 = 0.05, number(0.0, 10.0), "pixels", "images of order 2 and 3 narrower than this are left out";
        doppler: bool = true, Switch, "", "frequency shift of all light";
        beaming: bool = true, Switch, "", "brightness change that goes with the shift";
        lensing: bool = true, Switch, "", "bending of light; off draws flat space";
        light_delay: bool = true, Switch, "", "ships are seen at their emission time (the gas of the disk always is)";
        exposure_min: f64 = -12.0, number(-30.0, 30.0), "stops", "darkest exposure the eye adapts to";
        exposure_max: f64 = 3.0, number(-30.0, 30.0), "stops", "brightest exposure the eye adapts to";
        exposure_speed: f64 = 2.0, number(0.05, 60.0), "stops per second", "how fast exposure adapts";
        exposure_key: f64 = 0.35, number(0.01, 1.0), "", "light that what shines in the picture is brought to; 1 is white";
        antialiasing: bool = true, Switch, "", "outlines of ships and other bodies are smoothed";
        bloom: f64 = 0.3, number(0.0, 1.0), "", "share of light spread by the lens";
        ambient: f64 = 0.04, number(0.0, 2.0), "", "light from everywhere on ships and props";
        fill_least: f64 = 0.08, number(0.0, 10.0), "", "the player's own ship is lit so that its middle grey is at least so light; 1 is white";
        fill_most: f64 = 0.25, number(0.0, 10.0), "", "and shaded so that it is at most so light; 10 leaves the ship as it is";
    }
    /// Stars and Milky Way.
    sky: Sky {
        star_brightness: f64 = 0.35, number(0.0, 1000.0), "", "factor on the flux of every star";
        star_size: f64 = 1.1, number(0.5, 6.0), "pixels", "radius of a star's spot on the screen";
        faintest_magnitude: f64 = 12.0, number(0.0, 16.0), "magnitudes", "fainter stars are left out";
        milky_way_brightness: f64 = 0.4, number(0.0, 1000.0), "", "factor on the Milky Way";
    }
    /// The accretion disk.
    disk: Disk {
        representation: String = "arcs", Choice(&["arcs", "sprites", "polygons", "polygons-at-rest"]), "", "what the disk is made of";
        inner: f64 = 3.0, number(3.0, 50.0), "r_s", "inner edge of the orbits; from 3, the last stable one, gas goes on falling in";
        outer: f64 = 12.0, number(3.1, 200.0), "r_s", "outer edge";
        accretion_rate: f64 = 2.5e-5, number(1e-9, 10.0), "Eddington rates", "matter falling in; sets the temperature";
        efficiency: f64 = 0.0572, number(0.001, 0.5), "", "share of the accreted rest energy that is radiated";
        arcs: u32 = 4200u32, integer(16, 50_000), "arcs", "arcs in the disk";
        sprites: u32 = 100_000u32, integer(100, 2_000_000), "sprites", "point sprites in the disk";
        polygons: u32 = 960u32, integer(24, 200_000), "triangles", "triangles in the polygon disk";
        error_budget: f64 = 0.0003, number(1e-5, 0.1), "rad", "an arc is cut into more segments while its midpoint is off by more";
        width: f64 = 0.16, number(0.005, 2.0), "r_s", "width of an arc across its orbit; with arcs it sets how many there are round the hole";
        gap: f64 = 0.0, number(0.0, 0.9), "", "share of an arc left dark";
        thickness: f64 = 0.02, number(0.0, 0.5), "", "half height over radius, seen from within the disk";
        exposure_key: f64 = 1.1, number(0.01, 8.0), "", "light that what shines is brought to with the disk in the picture; 1 is white";
        opacity: f64 = 0.95, number(0.0, 1.0), "", "how much light from behind the disk stops, face on";
        turbulence: f64 = 0.6, number(0.0, 1.0), "", "contrast of streaks and knots";
        seed: u32 = 1u32, integer(0, u32::MAX), "", "which disk";
    }
    /// The aurora of a planet.
    aurora: AuroraConfig {
        enabled: bool = true, Switch, "", "the aurora is simulated and drawn";
        walk: String = "exact", Choice(&["exact", "linear"]), "", "between projected ends: exact, or linear on the screen as in Sekiguchi et al.";
        streaks: u32 = 24_000u32, integer(64, 200_000), "streaks", "most streaks drawn; fewer when the aurora is small on the screen";
        parts: u32 = 8u32, integer(4, 48), "parts", "parts in which the light along a streak is drawn";
        share: f64 = 0.33, number(0.02, 1.0), "", "most of a frame's time that it takes in the window: streaks become fewer and wider";
        radius: f64 = 0.8, number(0.05, 50.0), "km", "spread of a luminous point (the planet's radius is 6371 km)";
        energy: f64 = 4.0, number(0.5, 50.0), "keV", "energy that electrons gain in the potential above the aurora";
        thermal: f64 = 1.5, number(0.2, 20.0), "keV", "thermal energy on top of it";
        flux: f64 = 20.0, number(0.0, 1000.0), "erg cm^-2 s^-1", "energy flux in a curtain";
        brightness: f64 = 0.007, number(0.0, 10.0), "per kilorayleigh", "what a kilorayleigh of green light is in the picture";
        field: f64 = 50.0, number(0.0, 500.0), "mV/m", "electric field beside a curtain: how fast it folds";
        renewal: f64 = 60.0, number(1.0, 1000.0), "s", "time between two surges of new electrons, which bring a curtain back to its place";
        contrast: f64 = 0.7, number(0.0, 1.0), "", "contrast of the rays and of the brightness that travels along the curtains";
        pace: f64 = 4.0, number(0.0, 1000.0), "s per r_s/c", "how fast the aurora moves against the game's clock";
        seed: u32 = 1u32, integer(0, u32::MAX), "", "which aurora";
    }
    /// The player's ship.
    ship: ShipConfig {
        thrust: f64 = 0.06, number(0.0, 10.0), "c^2/r_s", "largest proper acceleration";
        fuel: f64 = 7.0, number(0.0, 1000.0), "c", "velocity change in the tanks";
        turn_rate: f64 = 1.2, number(0.05, 20.0), "rad per second", "fastest turn, by the second before the screen; at most as fast as a body turns";
        bolts: u32 = 0u32, integer(0, 1000), "bolts", "how many it may fire in a mission";
        size: f64 = 0.25, number(0.001, 10.0), "r_s", "length of the ship";
    }
    /// The ship that is chased.
    enemy: Enemy {
        thrust: f64 = 0.035, number(0.0, 10.0), "c^2/r_s", "largest proper acceleration";
        fuel: f64 = 4.0, number(0.0, 1000.0), "c", "velocity change in the tanks";
        replan_period: f64 = 2.5, number(0.05, 100.0), "r_s/c", "time between two plans";
        horizon: f64 = 40.0, number(1.0, 500.0), "r_s/c", "how far a plan looks ahead";
        reaction_delay: f64 = 1.0, number(0.0, 50.0), "r_s/c", "age of what it knows of the hunter";
        size: f64 = 0.25, number(0.001, 10.0), "r_s", "length of the ship";
    }
    /// What ends the chase.
    rules: RulesConfig {
        capture_radius: f64 = 0.5, number(0.01, 100.0), "r_s", "a catch needs the target this close";
        hold_time: f64 = 2.0, number(0.0, 1000.0), "r_s/c", "for this long without a break";
        time_limit: f64 = 400.0, number(1.0, 1e9), "r_s/c", "the hunter loses after this time";
        arena_radius: f64 = 20.0, number(5.0, 1e6), "r_s", "the quarry turns back before this radius";
    }
    /// Flight assistance.
    assist: Assist {
        enabled: bool = true, Switch, "", "damps drift and turning; off is pure free flight";
        reference: String = "orbit", Choice(&["orbit", "target"]), "", "what drift is damped against";
        damping_time: f64 = 3.0, number(0.1, 100.0), "r_s/c", "time in which unwanted drift fades";
        avoid_hole: bool = true, Switch, "", "pushes away from orbits that end in the hole";
        avoid_radius: f64 = 2.0, number(1.05, 50.0), "r_s", "closest approach the assistance allows";
    }
    /// Keyboard, mouse and gamepad.
    controls: Controls {
        mouse_sensitivity: f64 = 0.002, number(0.0, 0.05), "rad per pixel", "turn for a movement of the mouse";
        invert_y: bool = false, Switch, "", "mouse forward pitches down";
        thrust_forward: String = "KeyW PadLeftStickUp", Buttons, "", "accelerate";
        thrust_back: String = "KeyS PadLeftStickDown", Buttons, "", "brake";
        thrust_left: String = "KeyA PadLeftStickLeft", Buttons, "", "accelerate to the left";
        thrust_right: String = "KeyD PadLeftStickRight", Buttons, "", "accelerate to the right";
        thrust_up: String = "Space PadRightBumper", Buttons, "", "accelerate upwards";
        thrust_down: String = "ControlLeft PadLeftBumper", Buttons, "", "accelerate downwards";
        boost: String = "ShiftLeft PadSouth", Buttons, "", "full thrust while held";
        fire: String = "MouseLeft PadRightTrigger", Buttons, "", "fire a bolt, in missions that give some";
        pitch_up: String = "ArrowDown PadRightStickDown", Buttons, "", "nose up";
        pitch_down: String = "ArrowUp PadRightStickUp", Buttons, "", "nose down";
        yaw_left: String = "ArrowLeft PadRightStickLeft", Buttons, "", "nose left";
        yaw_right: String = "ArrowRight PadRightStickRight", Buttons, "", "nose right";
        roll_left: String = "KeyQ PadLeft", Buttons, "", "roll left";
        roll_right: String = "KeyE PadRight", Buttons, "", "roll right";
        toggle_assist: String = "KeyZ PadEast", Buttons, "", "flight assistance: orbit, target, off; held, it matches the target's motion";
        toggle_autopilot: String = "KeyP PadNorth", Buttons, "", "autopilot on or off";
        toggle_camera: String = "KeyC PadWest", Buttons, "", "cockpit or third person";
        look_at_target: String = "KeyV PadLeftTrigger", Buttons, "", "look at the target while held";
        face_target: String = "KeyF PadDown", Buttons, "", "while held: nose to where thrust leads to the target, the assist rests";
        toggle_hud: String = "KeyH", Buttons, "", "HUD on or off";
        toggle_overlay: String = "F3", Buttons, "", "dev overlay on or off";
        screenshot: String = "F12", Buttons, "", "write a picture";
        slower: String = "Comma PadLeftThumb", Buttons, "", "halve the pace";
        faster: String = "Period PadRightThumb", Buttons, "", "double the pace";
        pause: String = "Escape PadStart", Buttons, "", "pause and menu";
        restart: String = "KeyR", Buttons, "", "start the chase again";
        what_am_i_seeing: String = "F1 PadUp", Buttons, "", "names what is on the screen, while held or after a tap";
        photo_mode: String = "F2 PadSelect", Buttons, "", "photo mode: time stands still, the camera is free";
        toggle_full_screen: String = "F11", Buttons, "", "full screen or window";
        mute: String = "KeyM", Buttons, "", "sound off or on";
        tapped: String = "None", Words(HELD), "", "what a tap switches on and another off, instead of holding";
        invert_x: bool = false, Switch, "", "mouse to the right turns left";
        left_stick_dead_zone: f64 = 0.12, number(0.0, 0.9), "", "share of the left stick's way that does nothing";
        left_stick_curve: f64 = 1.6, number(1.0, 4.0), "", "exponent of its answer: 1 is straight, more is finer about the middle";
        right_stick_dead_zone: f64 = 0.12, number(0.0, 0.9), "", "share of the right stick's and the triggers' way that does nothing";
        right_stick_curve: f64 = 1.6, number(1.0, 4.0), "", "exponent of their answer";
        stick_pitch: f64 = 1.0, number(0.1, 2.0), "", "how strongly the stick pitches";
        stick_yaw: f64 = 1.0, number(0.1, 2.0), "", "how strongly the stick yaws";
        stick_thrust: f64 = 1.0, number(0.1, 2.0), "", "how strongly the stick thrusts";
        stick_invert_pitch: bool = false, Switch, "", "the stick pitches the other way";
        stick_invert_yaw: bool = false, Switch, "", "the stick yaws the other way";
        stick_invert_thrust: bool = false, Switch, "", "the stick thrusts the other way";
    }
    /// The window.
    video: Video {
        width: u32 = 1280u32, integer(160, 16384), "pixels", "width of the window at the start";
        height: u32 = 720u32, integer(90, 16384), "pixels", "height of the window at the start";
        fullscreen: bool = false, Switch, "", "fill the screen";
        vsync: bool = true, Switch, "", "wait for the screen";
        fov: f64 = 60.0, number(20.0, 150.0), "degrees", "horizontal field of view";
        pause_without_focus: bool = true, Switch, "", "the flight pauses when the window loses its focus";
        reduced_motion: bool = false, Switch, "", "the camera does not sway or glide";
        frame_limit: u32 = 0u32, integer(0, 1000), "frames per second", "no more frames than this; 0 is no limit";
        quality: String = "automatic", Choice(&["automatic", "low", "medium", "high"]), "", "how much is drawn; high: as the sections above say; automatic: what holds the rate";
        held_rate: u32 = 0u32, integer(0, 1000), "frames per second", "rate that automatic quality holds; 0 is the display's";
    }
    /// Sound.
    sound: Sound {
        master: f64 = 0.8, number(0.0, 1.0), "", "loudness of everything";
        effects: f64 = 0.8, number(0.0, 1.0), "", "loudness of engine, disk, bolts and alarms";
        music: f64 = 0.5, number(0.0, 1.0), "", "loudness of the music";
        beacon: f64 = 0.7, number(0.0, 1.0), "", "loudness of the target's beacon";
        mute_master: bool = false, Switch, "", "everything is silent";
        mute_effects: bool = false, Switch, "", "engine, disk, bolts and alarms are silent";
        mute_music: bool = false, Switch, "", "the music is silent";
        mute_beacon: bool = false, Switch, "", "the target's beacon is silent";
    }
    /// For eyes and hands of every kind.
    accessibility: Accessibility {
        text_size: f64 = 1.0, number(0.8, 2.0), "", "size of all text and panels";
        palette: String = "standard", Choice(&["standard", "red-green", "blue-yellow"]), "", "colours of markers and dials, for the kinds of colour blindness";
        high_contrast: bool = false, Switch, "", "text and markers white or yellow on black, with thicker lines";
        reduced_flashes: bool = false, Switch, "", "the picture's mean brightness rises by at most a tenth of white in a second";
    }
    /// What surrounds the picture.
    interface: Interface {
        language: String = "auto", Choice(&["auto", "en", "ja"]), "", "language of all words; auto is that of the system, English where it has another";
        hud: String = "full", Choice(&["full", "reduced", "least"]), "", "how much the HUD shows";
        coach: bool = true, Switch, "", "hints while one flies by hand, by what happens";
        warned: bool = false, Switch, "", "the warning at the first start has been read";
    }
}
