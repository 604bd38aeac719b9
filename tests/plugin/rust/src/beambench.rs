//! beambench's C interface, version 1, as in <beambench/contender.h>, which explains each member,
//! and the trait that a library implements to be a contender.
use std::ffi::{c_char, c_void, CStr};

const INTERFACE: u32 = 1;
const MISS: u32 = u32::MAX;
const TRIANGLES: u32 = 1;
const OK: i32 = 0;
const UNSUPPORTED: i32 = 1;

#[repr(C)]
pub struct Ray {
    pub origin: [f32; 3],
    pub t_min: f32,
    pub direction: [f32; 3],
    pub t_max: f32,
}

#[repr(C)]
pub struct Triangle {
    pub vertex: [u32; 3],
    pub primitive: u32,
}

/// The arrays of spheres and cones are omitted because a library of triangles never receives any.
#[repr(C)]
pub struct Scene {
    size: usize,
    primitive_count: usize,
    vertex_count: usize,
    vertices: *const [f32; 3],
    triangle_count: usize,
    triangles: *const Triangle,
}

impl Scene {
    pub fn vertices(&self) -> &[[f32; 3]] {
        unsafe { slice(self.vertices, self.vertex_count) }
    }
    pub fn triangles(&self) -> &[Triangle] {
        unsafe { slice(self.triangles, self.triangle_count) }
    }
    /// Returns the corners of each triangle.
    pub fn corners(&self) -> impl Iterator<Item = [[f32; 3]; 3]> + '_ {
        self.triangles().iter().map(|t| t.vertex.map(|v| self.vertices()[v as usize]))
    }
    /// Returns the primitive of each triangle.
    pub fn primitives(&self) -> Vec<u32> {
        self.triangles().iter().map(|t| t.primitive).collect()
    }
}

#[repr(C)]
pub struct Batch {
    size: usize,
    count: usize,
    rays: *const Ray,
    row: usize,
}

/// Returns an array as a slice. An empty array may be null.
unsafe fn slice<'a, T>(data: *const T, count: usize) -> &'a [T] {
    if count == 0 { &[] } else { std::slice::from_raw_parts(data, count) }
}

/// A structure over triangles.
pub trait Tracer: Sync + Sized {
    const NAME: &'static CStr;
    const DESCRIPTION: &'static CStr;
    /// The library and its version.
    const VERSION: &'static CStr;
    /// Whether rays may begin at t_min > 0. If not, batches with such rays are declined.
    const HAS_T_MIN: bool = true;

    fn build(scene: &Scene) -> Self;
    /// Returns t and the primitive of the closest hit in [t_min, t_max].
    fn closest_hit(&self, ray: &Ray) -> Option<(f32, u32)>;
    fn any_hit(&self, ray: &Ray) -> bool;
}

#[repr(C)]
pub struct Table {
    size: usize,
    name: *const c_char,
    description: *const c_char,
    version: *const c_char,
    supports: u32,
    create: unsafe extern "C" fn(*const Scene, *mut *mut c_void) -> i32,
    closest_hits: unsafe extern "C" fn(*const c_void, *const Batch, *mut f32, *mut u32) -> i32,
    any_hits: unsafe extern "C" fn(*const c_void, *const Batch, *mut u8) -> i32,
    destroy: unsafe extern "C" fn(*mut c_void),
    bytes: Option<unsafe extern "C" fn(*const c_void) -> usize>,
}

unsafe impl Sync for Table {}

impl Table {
    pub const fn of<T: Tracer>() -> Self {
        Table {
            size: std::mem::size_of::<Table>(),
            name: T::NAME.as_ptr(),
            description: T::DESCRIPTION.as_ptr(),
            version: T::VERSION.as_ptr(),
            supports: TRIANGLES,
            create: create::<T>,
            closest_hits: closest_hits::<T>,
            any_hits: any_hits::<T>,
            destroy: destroy::<T>,
            bytes: None,
        }
    }
    /// Returns the table. Sets `count` to 1, or to 0 if `version` is another interface version.
    pub unsafe fn export(&'static self, version: u32, count: *mut u32) -> *const Table {
        *count = (version == INTERFACE) as u32;
        self
    }
}

unsafe extern "C" fn create<T: Tracer>(scene: *const Scene, structure: *mut *mut c_void) -> i32 {
    *structure = Box::into_raw(Box::new(T::build(&*scene))).cast();
    OK
}

unsafe extern "C" fn closest_hits<T: Tracer>(
    structure: *const c_void,
    batch: *const Batch,
    t: *mut f32,
    primitive: *mut u32,
) -> i32 {
    each_ray::<T>(structure, batch, |i, ray, tracer| {
        (*t.add(i), *primitive.add(i)) = tracer.closest_hit(ray).unwrap_or((f32::INFINITY, MISS));
    })
}

unsafe extern "C" fn any_hits<T: Tracer>(
    structure: *const c_void,
    batch: *const Batch,
    hits: *mut u8,
) -> i32 {
    each_ray::<T>(structure, batch, |i, ray, tracer| *hits.add(i) = tracer.any_hit(ray) as u8)
}

unsafe fn each_ray<T: Tracer>(
    structure: *const c_void,
    batch: *const Batch,
    trace: impl Fn(usize, &Ray, &T),
) -> i32 {
    let rays = slice((*batch).rays, (*batch).count);
    if !T::HAS_T_MIN && rays.iter().any(|ray| ray.t_min > 0.0) {
        return UNSUPPORTED;
    }
    let tracer = &*structure.cast::<T>();
    for (i, ray) in rays.iter().enumerate() {
        trace(i, ray, tracer);
    }
    OK
}

unsafe extern "C" fn destroy<T: Tracer>(structure: *mut c_void) {
    drop(Box::from_raw(structure.cast::<T>()));
}

/// Makes a tracer the contender that the shared object exports.
#[macro_export]
macro_rules! contender {
    ($tracer:ty) => {
        #[no_mangle]
        pub unsafe extern "C" fn beambench_contenders(version: u32, count: *mut u32) -> *const beambench::Table {
            static TABLE: beambench::Table = beambench::Table::of::<$tracer>();
            TABLE.export(version, count)
        }
    };
}
