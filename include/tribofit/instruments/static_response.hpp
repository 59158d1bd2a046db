#pragma once

namespace tribofit {

/// How the gain of a channel depends on what it reads: reading = x (1 - part s(x)), s = 0 at zero. Such is an amplifier
/// near its limit, a decoder that compresses, a channel whose two directions have gains of their own. The gain at zero
/// is one: what scales the whole channel is another matter.
struct StaticResponse {
  enum class Form {
    square,    ///< s = (x/full_scale)^2: third-order term of an odd characteristic
    linear,    ///< s = |x/full_scale|: second-order term
    one_sided  ///< s = 1 where x has not the sign of full_scale
  };
  Form form = Form::square;
  double part = 0;        ///< of the gain that is lost where s = 1 [1]; negative: gained; 0: none
  double full_scale = 0;  ///< the largest true value, as x

  bool any() const { return part != 0; }
  /// What the channel shows of x, in its unit.
  double reading(double x) const;
  /// x from what the channel shows: the inverse of reading() within full_scale, by Newton's method.
  double undone(double reading) const;
  /// d reading/dx.
  double gain(double x) const;
  /// How much x changes where `part` is larger by one, at the same reading, to first order.
  double slope(double x) const { return x * lost(x) / gain(x); }

 private:
  double lost(double x) const;  ///< s(x)
};

/// A response that was found in a record and undone.
struct UndoneResponse {
  StaticResponse response;
  double std_error = 0;  ///< of its part
  bool any() const { return response.any(); }
};

}  // namespace tribofit
