//! parry3d: its triangle mesh, traced as a surface, not as a solid.
#[path = "../../../../../../tests/plugin/rust/src/beambench.rs"]
mod beambench;
use beambench::{Ray, Scene, Tracer};
use parry3d::math::Vector;
use parry3d::query;
use parry3d::shape::{CompositeShapeRef, TriMesh};
use std::ffi::CStr;

struct Parry {
    mesh: TriMesh,
    primitives: Vec<u32>,
}

impl Tracer for Parry {
    const NAME: &'static CStr = c"parry3d";
    const DESCRIPTION: &'static CStr = c"parry3d of crates.io: TriMesh, float";
    const VERSION: &'static CStr = c"parry3d 0.31.1";
    const HAS_T_MIN: bool = false;

    fn build(scene: &Scene) -> Self {
        let vertices = scene.vertices().iter().map(|v| Vector::new(v[0], v[1], v[2])).collect();
        let indices = scene.triangles().iter().map(|t| t.vertex).collect();
        let mesh = TriMesh::new(vertices, indices).expect("a scene has triangles");
        Parry { mesh, primitives: scene.primitives() }
    }

    fn closest_hit(&self, ray: &Ray) -> Option<(f32, u32)> {
        let [origin, direction] = [ray.origin, ray.direction].map(|v| Vector::new(v[0], v[1], v[2]));
        CompositeShapeRef(&self.mesh)
            .cast_local_ray(&query::Ray::new(origin, direction), ray.t_max.min(f32::MAX), false)
            .map(|(triangle, t)| (t, self.primitives[triangle as usize]))
    }

    fn any_hit(&self, ray: &Ray) -> bool {
        self.closest_hit(ray).is_some() // parry3d has no any-hit query
    }
}

contender!(Parry);
