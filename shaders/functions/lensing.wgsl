// Stopgap.
struct LensRay {
    cos_psi: f32,
    sin_psi: f32,
    delay: f32,
    frequency: f32,
    emission_radial: f32,
    emission_tangential: f32,
    emission_frequency: f32,
    valid: bool,
}

fn lens_lookup(along: f32, across: f32, order: u32) -> LensRay {
    let l = frame.radial.w;
    let a = 1.0 / l;
    let z = l + along;
    let r = length(vec2<f32>(z, across));
    let c = 1.0 / r;
    var sp = across * c;
    let cp = z * c;
    if order == 2u { sp = -sp; }
    let k = 1.0 - cp;
    let b = sp * (1.0 + a * k);
    let q = c - a * cp - 1.5 * a * a * k + 0.5 * a * a * k * k;
    let root = sqrt(max(b * b + 2.0 * k * k * q, 0.0));
    var w = 2.0 * q / (b + root);
    if b < 0.0 { w = (root - b) / (k * k); }
    let e = sqrt(max(w * w + a * a - a * a * a, 0.0));
    let beta = sqrt(a);
    var pr: f32;
    if w < 0.0 || a >= 1.0 { pr = (a * a - e * e) / (beta * e - w); } else { pr = (beta * e + w) / (1.0 - a); }
    let om = length(vec2<f32>(pr, a));
    var ray: LensRay;
    ray.cos_psi = -pr / om;
    ray.sin_psi = a / om;
    ray.frequency = om;
    ray.delay = sqrt(along * along + across * across);
    let be = sqrt(c);
    // emission slope of the flat line, scaled to e
    let we2 = sqrt(max(e * e - c * c + c * c * c, 0.0));
    let fw = -a * sp + w * cp;
    let we = select(-we2, we2, fw > 0.0);
    if we < 0.0 || c >= 1.0 { ray.emission_radial = (c * c - e * e) / (be * e - we); } else { ray.emission_radial = (be * e + we) / (1.0 - c); }
    ray.emission_tangential = c;
    ray.emission_frequency = length(vec2<f32>(ray.emission_radial, c));
    ray.valid = r > 1.0 && order < 3u;
    return ray;
}
