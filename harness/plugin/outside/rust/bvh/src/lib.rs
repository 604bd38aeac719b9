//! bvh: its hierarchy and its triangle test, which hits only one side, so both sides are tested.
#[path = "../../../../../../tests/plugin/rust/src/beambench.rs"]
mod beambench;
use beambench::{Ray, Scene, Tracer};
use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use bvh::bvh::Bvh;
use nalgebra::{Point3, Vector3};
use std::ffi::CStr;

struct Triangle {
    corners: [Point3<f32>; 3],
    primitive: u32,
    node: usize,
}

impl Bounded<f32, 3> for Triangle {
    fn aabb(&self) -> Aabb<f32, 3> {
        let [a, b, c] = self.corners;
        Aabb::with_bounds(a.inf(&b).inf(&c), a.sup(&b).sup(&c))
    }
}

impl BHShape<f32, 3> for Triangle {
    fn set_bh_node_index(&mut self, index: usize) {
        self.node = index;
    }
    fn bh_node_index(&self) -> usize {
        self.node
    }
}

struct Library {
    bvh: Bvh<f32, 3>,
    triangles: Vec<Triangle>,
}

impl Library {
    /// Calls `visit` with the t and the primitive of each hit in the interval.
    fn hits<'a>(&'a self, ray: &'a Ray) -> impl Iterator<Item = (f32, u32)> + 'a {
        let direction = Vector3::from(ray.direction);
        let unit = direction.norm(); // the library normalizes
        let query = bvh::ray::Ray::new(Point3::from(ray.origin), direction);
        self.bvh.traverse(&query, &self.triangles).into_iter().filter_map(move |triangle| {
            let [a, b, c] = &triangle.corners;
            let distance = query.intersects_triangle(a, b, c).distance;
            let t = distance.min(query.intersects_triangle(a, c, b).distance) / unit;
            (t <= ray.t_max && t < f32::INFINITY).then_some((t, triangle.primitive))
        })
    }
}

impl Tracer for Library {
    const NAME: &'static CStr = c"bvh-rs";
    const DESCRIPTION: &'static CStr = c"bvh of crates.io: binary hierarchy, float, directions normalized";
    const VERSION: &'static CStr = c"bvh 0.12.0";
    const HAS_T_MIN: bool = false;

    fn build(scene: &Scene) -> Self {
        let made = |(corners, primitive): ([[f32; 3]; 3], u32)| Triangle {
            corners: corners.map(Point3::from),
            primitive,
            node: 0,
        };
        let mut triangles: Vec<_> = scene.corners().zip(scene.primitives()).map(made).collect();
        Library { bvh: Bvh::build(&mut triangles), triangles }
    }

    fn closest_hit(&self, ray: &Ray) -> Option<(f32, u32)> {
        self.hits(ray).min_by(|a, b| a.0.total_cmp(&b.0))
    }

    fn any_hit(&self, ray: &Ray) -> bool {
        self.hits(ray).next().is_some()
    }
}

contender!(Library);
