//! What voices are made of: numbers that glide, blows that ring, tones, noise, and the way from left to right.

use fundsp::prelude64::{An, BandpassMode, LowpassMode, Noise, Sine, Svf, bandpass, lowpass, noise, sine};

/// Below this a gliding number is where it goes to: −120 dB of what is full.
const THERE: f64 = 1e-6;

/// A number that follows its target without a jump or a kink: two low-pass filters of first order, one after the other.
#[derive(Clone, Copy, Debug)]
pub struct Glide {
    target: f64,
    between: f64,
    value: f64,
    /// The share of the way that one sample covers.
    share: f64,
}

impl Glide {
    /// At rest at `value`; each of its two filters has the time constant `seconds`, at `rate` samples a second.
    pub fn new(value: f64, seconds: f64, rate: f64) -> Glide {
        Glide { target: value, between: value, value, share: 1.0 - (-1.0 / (seconds * rate)).exp() }
    }

    /// Goes to `target` from now on; what is not finite changes nothing.
    pub fn aim(&mut self, target: f64) {
        if target.is_finite() {
            self.target = target;
        }
    }

    /// Is at `target` at once: for what cannot be heard now.
    pub fn jump(&mut self, target: f64) {
        self.aim(target);
        (self.between, self.value) = (self.target, self.target);
    }

    /// The next sample.
    #[allow(clippy::should_implement_trait)]
    pub fn next(&mut self) -> f64 {
        self.between += (self.target - self.between) * self.share;
        self.value += (self.between - self.value) * self.share;
        if (self.target - self.between).abs() + (self.target - self.value).abs() < THERE {
            (self.between, self.value) = (self.target, self.target);
        }
        self.value
    }

    /// Where it is now.
    pub fn now(&self) -> f64 {
        self.value
    }

    /// Whether it rests at `value`.
    pub fn rests_at(&self, value: f64) -> bool {
        self.value == value && self.target == value
    }
}

/// The loudness of something struck: it swells softly and rings out.
#[derive(Clone, Copy, Debug)]
pub struct Ring {
    drive: f64,
    value: f64,
    attack: f64,
    decay: f64,
}

impl Ring {
    /// Swells and rings out with these time constants in seconds, at `rate` samples a second.
    pub fn new(attack: f64, decay: f64, rate: f64) -> Ring {
        let left = |seconds: f64| (-1.0 / (seconds * rate)).exp();
        Ring { drive: 0.0, value: 0.0, attack: 1.0 - left(attack), decay: left(decay) }
    }

    /// Strikes it; 1 is full strength.
    pub fn strike(&mut self, strength: f64) {
        self.drive = self.drive.max(strength);
    }

    /// The next sample.
    #[allow(clippy::should_implement_trait)]
    pub fn next(&mut self) -> f64 {
        self.drive *= self.decay;
        self.value += (self.drive - self.value) * self.attack;
        if self.drive + self.value < THERE {
            (self.drive, self.value) = (0.0, 0.0);
        }
        self.value
    }

    /// Whether nothing rings.
    pub fn is_silent(&self) -> bool {
        self.drive == 0.0 && self.value == 0.0
    }
}

/// A sine whose frequency may change at any time; its phase goes on.
pub struct Tone(An<Sine<f64>>);

impl Tone {
    /// At `rate` samples a second; its phase begins at 0.
    pub fn new(rate: f64) -> Tone {
        let mut tone = sine();
        tone.set_sample_rate(rate);
        Tone(tone)
    }

    /// The next sample at this frequency, in Hz.
    pub fn next(&mut self, frequency: f64) -> f64 {
        f64::from(self.0.filter_mono(frequency as f32))
    }
}

/// White noise from −1 to 1.
pub struct Hiss(An<Noise>);

impl Hiss {
    /// Different seeds give noises that have nothing to do with each other; the same gives the same.
    pub fn new(seed: u64) -> Hiss {
        Hiss(noise().seed(seed))
    }

    /// The next sample.
    #[allow(clippy::should_implement_trait)]
    pub fn next(&mut self) -> f64 {
        f64::from(self.0.get_mono())
    }
}

/// A filter that lets low frequencies through.
pub struct Low(An<Svf<f64, LowpassMode<f64>>>);

impl Low {
    /// At `rate` samples a second.
    pub fn new(rate: f64) -> Low {
        let mut filter = lowpass();
        filter.set_sample_rate(rate);
        Low(filter)
    }

    /// The next sample, with the corner at `frequency` Hz and without a peak there.
    pub fn next(&mut self, input: f64, frequency: f64) -> f64 {
        let out = self.0.tick(&[input as f32, frequency as f32, std::f32::consts::FRAC_1_SQRT_2].into());
        f64::from(out[0])
    }
}

/// A filter that lets a band of frequencies through.
pub struct Band(An<Svf<f64, BandpassMode<f64>>>);

impl Band {
    /// At `rate` samples a second.
    pub fn new(rate: f64) -> Band {
        let mut filter = bandpass();
        filter.set_sample_rate(rate);
        Band(filter)
    }

    /// The next sample, with the band at `frequency` Hz, `narrow` times narrower than that.
    pub fn next(&mut self, input: f64, frequency: f64, narrow: f64) -> f64 {
        let out = self.0.tick(&[input as f32, frequency as f32, narrow as f32].into());
        f64::from(out[0])
    }
}

/// A sound from the direction `pan` (−1 left, 1 right), left and right; equally loud from everywhere.
pub fn panned(sound: f64, pan: f64) -> [f64; 2] {
    let (right, left) = (std::f64::consts::FRAC_PI_4 * (1.0 + pan.clamp(-1.0, 1.0))).sin_cos();
    [sound * left, sound * right]
}

/// The sum of two sounds.
pub fn plus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

/// A sound, made louder or softer.
pub fn times(a: [f64; 2], gain: f64) -> [f64; 2] {
    a.map(|side| side * gain)
}
