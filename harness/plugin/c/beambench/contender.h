/* The C interface of beambench: a ray tracing library as a contender, in a shared object.
 *
 * The object exports one function, `beambench_contenders`, which returns a table for each structure:
 *
 *     static const beambench_contender mine = {
 *         .size = sizeof(mine), .name = "mine", .description = "what it is, in a sentence",
 *         .supports = BEAMBENCH_TRIANGLES, .create = create, .closest_hits = closest_hits,
 *         .any_hits = any_hits, .destroy = destroy};
 *     const beambench_contender* beambench_contenders(uint32_t version, uint32_t* count) {
 *       *count = version == BEAMBENCH_C_INTERFACE ? 1 : 0;
 *       return &mine;
 *     }
 *
 * `beambench --plugin ./libmine.so` loads it. Any language that can export such a function will do;
 * tests/plugin/c and tests/plugin/rust are complete. The interface depends neither on beambench's
 * C++ types nor on its compiler.
 *
 * Versions: the layout of a struct never changes within a version, except that members may be added
 * at its end; `size` states which of them exist. Functions must not throw or unwind.
 */
#ifndef BEAMBENCH_CONTENDER_H
#define BEAMBENCH_CONTENDER_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define BEAMBENCH_C_INTERFACE 1u
/* The primitive of a ray that hits nothing; its t is infinity. */
#define BEAMBENCH_MISS 0xFFFFFFFFu

/* The flags of `supports`; cells with other primitives get the verdict "unsupported". */
#define BEAMBENCH_TRIANGLES 1u
#define BEAMBENCH_SPHERES 2u
#define BEAMBENCH_CONES 4u

/* The return values of functions. */
#define BEAMBENCH_OK 0
#define BEAMBENCH_UNSUPPORTED 1 /* the query or this input is declined: no time, no error */
#define BEAMBENCH_FAILED 2      /* an error */

/* The points origin + t direction with t in the closed interval [t_min, t_max], t_max perhaps
 * infinite. Directions need not have unit length, and t is in units of the direction. */
typedef struct beambench_ray {
  float origin[3];
  float t_min;
  float direction[3];
  float t_max;
} beambench_ray;

/* Three indices into the vertices, and the primitive of which the triangle is part: a polygon is one
 * primitive of one or more triangles, which follow one another. Seen from both sides. */
typedef struct beambench_triangle {
  uint32_t vertex[3];
  uint32_t primitive;
} beambench_triangle;

/* A hollow sphere. Where `inside_only` is not 0, rays hit it only where they leave it. */
typedef struct beambench_sphere {
  float center[3];
  float radius;
  uint32_t inside_only;
  uint32_t primitive;
} beambench_sphere;

/* The lateral surface of a cone frustum or cylinder, without caps. */
typedef struct beambench_cone {
  float base[3];
  float base_radius;
  float apex[3];
  float apex_radius;
  uint32_t inside_only;
  uint32_t primitive;
} beambench_cone;

/* The arrays of a scene. They stay where they are until `destroy` returns, so they need no copy. All
 * numbers are finite; every primitive from 0 to primitive_count - 1 occurs.
 *
 * Every count may be 0, and the pointer beside it is then null or must not be read: `beambench
 * selftest` traces a scene without any primitives, in which every ray misses. Kinds of primitives
 * that `supports` leaves out do not occur. */
typedef struct beambench_scene {
  size_t size; /* sizeof(beambench_scene) in the program */
  size_t primitive_count;
  size_t vertex_count;
  const float* vertices; /* x, y, z of each vertex, without padding */
  size_t triangle_count;
  const beambench_triangle* triangles;
  size_t sphere_count;
  const beambench_sphere* spheres;
  size_t cone_count;
  const beambench_cone* cones;
} beambench_scene;

/* The rays of one query: a list, or neighboring rays of an image, row by row from the top left. The
 * count may be 0. */
typedef struct beambench_batch {
  size_t size; /* sizeof(beambench_batch) in the program */
  size_t count;
  const beambench_ray* rays;
  size_t row; /* rays in a row of the image; a pixel's samples are adjacent; 0: a list */
} beambench_batch;

/* One structure. All functions are called with the table's own structures only. `beambench selftest`
 * and `verify --kit` end a scene's build and queries after --timeout seconds. */
typedef struct beambench_contender {
  size_t size;             /* sizeof(beambench_contender) in the shared object */
  const char* name;        /* letters, digits, '-' and '_'; begins with a letter */
  const char* description; /* one sentence; `beambench list` prints it */
  const char* version;     /* the library and its version, "obvhs 0.4.0"; null: not stated */
  uint32_t supports;       /* BEAMBENCH_TRIANGLES | ... */
  /* Builds the structure on this thread, and stores it. Timed as the build. */
  int (*create)(const beambench_scene* scene, void** structure);
  /* Store the closest hit of each ray in t[i] and primitive[i]; hits[i] is 1 where a ray hits
   * anything, and 0 elsewhere. Timed as the trace. They trace on the calling thread, and several
   * threads may call them at once. any_hits may be null: then any-hit rays are unsupported. */
  int (*closest_hits)(const void* structure, const beambench_batch* batch, float* t,
                      uint32_t* primitive);
  int (*any_hits)(const void* structure, const beambench_batch* batch, uint8_t* hits);
  void (*destroy)(void* structure);
  /* The bytes that the structure holds; null: unknown. */
  size_t (*bytes)(const void* structure);
} beambench_contender;

/* Exported by the shared object. Returns an array of tables that stays valid, and stores their
 * number: 0 where it does not have this version of the interface. */
#if defined(__GNUC__)
__attribute__((visibility("default")))
#endif
const beambench_contender*
beambench_contenders(uint32_t version, uint32_t* count);

#ifdef __cplusplus
}
#endif

#endif
