#pragma once
// Exposure and tone curve for displays, chosen for each picture.

#include "harness/render/picture/image.hpp"

namespace beambench::render {

/// Maps linear light to display values. Uses the curve of Reinhard, Stark, Shirley and Ferwerda
/// ("Photographic tone reproduction for digital images", SIGGRAPH 2002, equation 4), including the
/// amount of light that becomes white. It is applied to a pixel's brightest component, because a
/// display clips that one first; the other components keep their ratio to it, which preserves hue
/// and saturation.
class ToneCurve {
 public:
  /// The display value of `white` after the exposure; 254 of 255 in an 8-bit file.
  static constexpr double kPeak = 0.99;

  /// Light is multiplied by `exposure`; after that, `white`, at least kPeak, becomes kPeak. A curve
  /// whose white is kPeak only changes the exposure.
  explicit ToneCurve(double exposure = 1.0, double white = kPeak);

  /// Returns the exposure in stops: the power of two by which light is multiplied.
  double stops() const;
  double white() const { return white_; }

  /// Maps a pixel's brightest component, which must be finite and not negative. The function is
  /// increasing, and at most 1.
  double operator()(double brightest) const;

 private:
  double exposure_;
  double white_;
};

/// Chooses the curve for a picture. White is chosen so that at most 1% of the lit pixels are
/// brighter. If the mean light (the logarithmic mean of luminances) is between the low and the high
/// key of Reinhard et al., or nothing is too bright to be shown, the exposure stays. A darker
/// picture is raised to the low key; a brighter one is lowered to the high key or until nothing is
/// too bright. Pixels without light are ignored; a completely black picture gets a curve that
/// changes nothing.
ToneCurve choose_tone(const Image& image);

/// Applies the curve. Pixels that are black or not finite stay as they are.
void apply(Image& image, const ToneCurve& curve);

}  // namespace beambench::render
