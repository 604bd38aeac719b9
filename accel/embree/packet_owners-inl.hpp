// The owners of a packet's hits. Compiled for each of Highway's targets: the including file is
// included several times.

#if defined(BEAMBENCH_EMBREE_PACKET_OWNERS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BEAMBENCH_EMBREE_PACKET_OWNERS_INL
#undef BEAMBENCH_EMBREE_PACKET_OWNERS_INL
#else
#define BEAMBENCH_EMBREE_PACKET_OWNERS_INL
#endif

#include <hwy/highway.h>

#include "accel/embree/native_scene.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::embree::HWY_NAMESPACE {

/// Applies `NativeScene::owner` to all lanes of a packet of N; `owners` must be aligned to a cache
/// line.
template <int N, class Hits>
HWY_INLINE void find_owners(const OwnerTable& table, const Hits& hits,
                            scenes::PrimitiveId* owners) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::CappedTag<scenes::PrimitiveId, N> words;
  const hn::RebindToSigned<decltype(words)> numbers;
  constexpr std::size_t kLanes = hn::MaxLanes(words);
  for (std::size_t i = 0; i < N / kLanes; ++i) {  // GCC 12 warns of an infinite loop over lanes
    const std::size_t lane = i * kLanes;
    const auto geometry = hn::Load(words, hits.geomID + lane);
    const auto hit = hn::Ne(geometry, hn::Set(words, RTC_INVALID_GEOMETRY_ID));
    auto owner = hn::Load(words, hits.primID + lane);
    for (unsigned id = 1; id < table.first.size(); ++id) {
      owner = hn::Add(owner, hn::IfThenElseZero(hn::Eq(geometry, hn::Set(words, id)),
                                                hn::Set(words, table.first[id])));
    }
    if (!table.in_order && !hn::AllFalse(words, hit)) {
      owner = hn::GatherIndex(words, table.ids.data(),
                              hn::BitCast(numbers, hn::IfThenElseZero(hit, owner)));
    }
    hn::Store(hn::IfThenElse(hit, owner, hn::Set(words, scenes::kNoPrimitive)), words,
              owners + lane);
  }
}

}  // namespace beambench::accel::embree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
