//! obvhs: its compressed hierarchy with eight children per node, and its own triangle test.
#[path = "../../../../../../tests/plugin/rust/src/beambench.rs"]
mod beambench;
use beambench::{Ray, Scene, Tracer};
use glam::Vec3A;
use obvhs::cwbvh::{builder::build_cwbvh_from_tris, CwBvh};
use obvhs::{ray::RayHit, triangle::Triangle, BvhBuildParams};
use std::{ffi::CStr, time::Duration};

struct Obvhs {
    bvh: CwBvh,
    triangles: Vec<Triangle>, // in the order of the leaves
    primitives: Vec<u32>,
}

fn converted(ray: &Ray) -> obvhs::ray::Ray {
    obvhs::ray::Ray::new(ray.origin.into(), ray.direction.into(), ray.t_min, ray.t_max)
}

impl Tracer for Obvhs {
    const NAME: &'static CStr = c"obvhs";
    const DESCRIPTION: &'static CStr = c"obvhs of crates.io: CWBVH, medium build, float";
    const VERSION: &'static CStr = c"obvhs 0.4.0";

    fn build(scene: &Scene) -> Self {
        let given: Vec<Triangle> = scene
            .corners()
            .map(|t| t.map(Vec3A::from))
            .map(|[v0, v1, v2]| Triangle { v0, v1, v2 })
            .collect();
        let bvh = build_cwbvh_from_tris(&given, BvhBuildParams::medium_build(), &mut Duration::default());
        let primitives = scene.primitives();
        let order = || bvh.primitive_indices.iter().map(|i| *i as usize);
        Obvhs {
            triangles: order().map(|i| given[i]).collect(),
            primitives: order().map(|i| primitives[i]).collect(),
            bvh,
        }
    }

    fn closest_hit(&self, ray: &Ray) -> Option<(f32, u32)> {
        let mut hit = RayHit::none();
        self.bvh
            .ray_traverse(converted(ray), &mut hit, |ray, i| self.triangles[i].intersect(ray))
            .then(|| (hit.t, self.primitives[hit.primitive_id as usize]))
    }

    fn any_hit(&self, ray: &Ray) -> bool {
        !self.bvh.ray_traverse_miss(converted(ray), |ray, i| self.triangles[i].intersect(ray))
    }
}

contender!(Obvhs);
