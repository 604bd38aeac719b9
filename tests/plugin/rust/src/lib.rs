//! A contender in Rust that tests all triangles; replace these tests with your library's calls.
mod beambench;
use beambench::{Ray, Scene, Tracer};
use std::ffi::CStr;

struct Mine {
    corners: Vec<[[f64; 3]; 3]>,
    primitives: Vec<u32>,
}

/// Returns a . (b x c).
fn det(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

impl Tracer for Mine {
    const NAME: &'static CStr = c"mine-in-rust";
    const DESCRIPTION: &'static CStr = c"tests all triangles, in Rust";
    const VERSION: &'static CStr = c"mine 1.0";

    fn build(scene: &Scene) -> Self {
        let corners = scene.corners().map(|t| t.map(|p| p.map(f64::from))).collect();
        Mine { corners, primitives: scene.primitives() }
    }

    fn closest_hit(&self, ray: &Ray) -> Option<(f32, u32)> {
        let mut closest = None;
        let mut nearest = f32::INFINITY;
        let d = ray.direction.map(f64::from);
        for (corners, primitive) in self.corners.iter().zip(&self.primitives) {
            let [a, b, c] = corners.map(|p| std::array::from_fn(|k| p[k] - f64::from(ray.origin[k])));
            let (u, v, w) = (det(d, b, c), det(d, c, a), det(d, a, b));
            let inside = (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
            let t = (det(a, b, c) / (u + v + w)) as f32;
            if inside && t >= ray.t_min && t <= ray.t_max && t < nearest {
                nearest = t;
                closest = Some((t, *primitive));
            }
        }
        closest
    }

    fn any_hit(&self, ray: &Ray) -> bool {
        self.closest_hit(ray).is_some()
    }
}

contender!(Mine);
