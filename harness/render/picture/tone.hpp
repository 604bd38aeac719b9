#pragma once
// An exposure and a tone curve for a display, chosen by the picture itself.

#include "harness/render/picture/image.hpp"

namespace beambench::render {

/// How linear light becomes what a display shows. The curve is that of Reinhard, Stark, Shirley and
/// Ferwerda ("Photographic tone reproduction for digital images", SIGGRAPH 2002, equation 4), with
/// the light that becomes white. It is applied to a pixel's brightest component, because a display
/// clips that one first, and the others keep their ratio to it: hue and saturation stay.
class ToneCurve {
 public:
  /// Becomes the light of `white` after the exposure; 254 of 255 in a file of 8 bits.
  static constexpr double kPeak = 0.99;

  /// Light is multiplied by `exposure`; what is then `white`, at least kPeak, becomes kPeak. A
  /// curve whose white is kPeak only exposes.
  explicit ToneCurve(double exposure = 1.0, double white = kPeak);

  /// In stops: the power of two that light is multiplied by.
  double stops() const;
  double white() const { return white_; }

  /// What becomes of a pixel's brightest component, finite and not negative: rises with it, and is
  /// 1 at most.
  double operator()(double brightest) const;

 private:
  double exposure_;
  double white_;
};

/// The curve for a picture. White is so bright that one of a hundred of its lit pixels, at most, is
/// brighter. Where the mean light (that of the logarithms of the luminances) is between what
/// Reinhard et al. call a low and a high key, or nothing is too bright to be shown, the exposure
/// stays; a darker picture is lifted to the low key, a brighter one is lowered to the high key or
/// until nothing is too bright. Pixels without light count for nothing; a picture of nothing else
/// gets a curve that changes nothing.
ToneCurve choose_tone(const Image& image);

/// Pixels that are black, or not finite, stay as they are.
void apply(Image& image, const ToneCurve& curve);

}  // namespace beambench::render
