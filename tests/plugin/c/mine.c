/* A contender in C that tests all triangles; replace these tests with your library's calls. */
#include <beambench/contender.h>
#include <math.h>

typedef struct { float t; uint32_t primitive; } hit;

/* Returns a . (b x c). */
static double det(const double* a, const double* b, const double* c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

static hit trace(const beambench_scene* scene, const beambench_ray* ray) {
  hit closest = {INFINITY, BEAMBENCH_MISS};
  for (size_t i = 0; i < scene->triangle_count; ++i) {
    const beambench_triangle* triangle = &scene->triangles[i];
    double d[3], corner[3][3]; /* from the origin of the ray */
    for (int k = 0; k < 3; ++k) {
      d[k] = ray->direction[k];
      for (int v = 0; v < 3; ++v)
        corner[v][k] = (double)scene->vertices[3 * triangle->vertex[v] + k] - ray->origin[k];
    }
    const double u = det(d, corner[1], corner[2]), v = det(d, corner[2], corner[0]);
    const double w = det(d, corner[0], corner[1]), sum = u + v + w;
    if (sum == 0 || !((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0))) continue;
    const float t = (float)(det(corner[0], corner[1], corner[2]) / sum);
    if (t >= ray->t_min && t <= ray->t_max && t < closest.t) closest = (hit){t, triangle->primitive};
  }
  return closest;
}

static int create(const beambench_scene* scene, void** structure) {
  *structure = (void*)scene; /* its arrays stay where they are */
  return BEAMBENCH_OK;
}

static int closest_hits(const void* scene, const beambench_batch* batch, float* t, uint32_t* ids) {
  for (size_t i = 0; i < batch->count; ++i) {
    const hit found = trace(scene, &batch->rays[i]);
    t[i] = found.t;
    ids[i] = found.primitive;
  }
  return BEAMBENCH_OK;
}

static int any_hits(const void* scene, const beambench_batch* batch, uint8_t* hits) {
  for (size_t i = 0; i < batch->count; ++i)
    hits[i] = trace(scene, &batch->rays[i]).primitive != BEAMBENCH_MISS;
  return BEAMBENCH_OK;
}

static void destroy(void* scene) { (void)scene; }

static const beambench_contender mine = {sizeof(mine), "mine-in-c", "tests all triangles, in C",
    "mine 1.0", BEAMBENCH_TRIANGLES, create, closest_hits, any_hits, destroy, NULL};

const beambench_contender* beambench_contenders(uint32_t version, uint32_t* count) {
  *count = version == BEAMBENCH_C_INTERFACE ? 1 : 0;
  return &mine;
}
