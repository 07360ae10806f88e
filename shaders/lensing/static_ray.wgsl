#define_import_path lensrunner::lensing::static_ray

// From what a static camera sees to the ray, for methods that only tell that.

#import lensrunner::lensing::closed_form::{energy, LensCamera, SourcePoint}
#import lensrunner::lensing::lookup::{LensRay, ray_of}

fn static_ray(cam: LensCamera, at: SourcePoint, order: u32, psi: f32, delay: f32) -> LensRay {
    // From the static angle the rest follows; on which side of a turning point the light left, as straight light would.
    let c = 1.0 / at.r;
    let lapse2 = max(at.lapse_squared, 1e-4);
    let w = -cam.a * sqrt(cam.lapse_squared) * cos(psi) / max(sin(psi), 1e-7);
    let e = energy(w, cam.a, cam.lapse_squared);
    let w_e = sqrt(max(e * e - c * c * lapse2, 0.0));
    let leaves_inward = c * cos(at.phi) > cam.a && order == 1u;
    return ray_of(cam, c, lapse2, w, e, select(-w_e, w_e, leaves_inward), delay);
}
