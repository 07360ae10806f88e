//! Stub.
/// Stub.
pub fn table(n: usize, a: f32, b: f32) -> Vec<[f32; 4]> {
    (0..n).map(|i| { let t = a * (b / a).powf(i as f32 / (n - 1) as f32); let l = |nm: f32| { let x = 1.4388e7 / (nm * t); let x0: f32 = 1.4388e7 / (550.0 * 5772.0); x0.exp_m1().ln() - if x > 30.0 { x } else { x.exp_m1().ln() } }; [l(611.0), l(549.0), l(464.0), 0.0] }).collect()
}
