// SPDX-License-Identifier: Apache-2.0
// The Python module talisman._talisman: numbers in and out. What users see is talisman/__init__.py.
#include <cstdint>
#include <cstring>
#include <exception>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "sequences/files/cache.h"
#include "sequences/files/errors.h"
#include "sequences/python/calls.h"
#include "sequences/python/decision_columns.h"
#include "warp/fit.h"

namespace {

using namespace talisman;
namespace py = pybind11;

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// The pairs of an array of shape (n, 2).
std::span<const layers::dvec2> points_of(const Doubles& array) {
  static_assert(sizeof(layers::dvec2) == 2 * sizeof(double));
  if (array.ndim() != 2 || array.shape(1) != 2) throw py::value_error("points must have the shape (n, 2)");
  return {reinterpret_cast<const layers::dvec2*>(array.data()), static_cast<std::size_t>(array.shape(0))};
}

py::dict fit(const Doubles& points, const Doubles& targets, const std::string& curve_name) {
  const std::optional<warp::Curve> curve = warp::curve_from_name(curve_name);
  if (!curve) throw py::value_error("'" + curve_name + "' is no warp curve");
  const auto then_px = points_of(points), now_px = points_of(targets);
  if (then_px.size() != now_px.size()) throw py::value_error("as many targets as points are needed");
  warp::FitResult fitted;
  {
    const py::gil_scoped_release others_run;
    fitted = warp::fit(then_px, now_px, *curve);
  }
  py::array_t<double> matrix({3, 3});
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      matrix.mutable_at(row, column) = fitted.warp.now_from_then[column][row];
  py::dict result;
  result["warp"] = matrix;
  result["family"] = std::string(warp::name(fitted.warp.family));
  result["status"] = std::string(warp::name(fitted.status));
  result["rms_px"] = fitted.rms_px;
  result["max_px"] = fitted.max_px;
  result["lower_px"] = fitted.max_lower_bound_px;
  result["worst_point"] = fitted.worst_point;
  result["iterations"] = fitted.iterations;
  return result;
}

/// Between two frames: Ctrl-C ends the call.
void heed_signals() {
  const py::gil_scoped_acquire ours;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

void warn(const sequences::Call& call) {
  const py::object warning = py::module_::import("warnings").attr("warn");
  for (const std::string& text : call.warnings()) warning(text);
}

using Words = std::vector<std::string>;

sequences::Call called(const std::string& sequence, const Words& words, bool plan_only) {
  const py::gil_scoped_release others_run;
  return {sequence, words, plan_only};
}

py::dict plan(const std::string& sequence, const Words& words) {
  const sequences::Call call = called(sequence, words, true);
  warn(call);
  sequences::DecisionColumns columns;
  {
    const py::gil_scoped_release others_run;
    call.plan(heed_signals, [&](const auto& state, const auto& report) { columns.add(state, report); });
  }
  py::dict result;
  for (const sequences::DecisionColumn& column : columns.columns())
    std::visit([&](const auto& values) { result[column.name.c_str()] = py::cast(values); }, column.values);
  return result;
}

py::array_t<std::uint8_t> render(const std::string& sequence, int frame, const Words& words) {
  const sequences::Call call = called(sequence, words, false);
  warn(call);
  sequences::Image8 image;
  {
    const py::gil_scoped_release others_run;
    image = call.draw(frame, heed_signals);
  }
  py::array_t<std::uint8_t> pixels({image.height, image.width, 3});
  std::memcpy(pixels.mutable_data(), image.rgb.data(), image.rgb.size());
  return pixels;
}

}  // namespace

PYBIND11_MODULE(_talisman, module) {
  talisman::sequences::use_cache({talisman::sequences::default_cache_folder()});  // as the tool does
  module.doc() = "What talisman/__init__.py is made of; not for others.";
  // Registered for this module alone; std::runtime_error is Python's RuntimeError already.
  py::register_local_exception_translator(
      [](std::exception_ptr thrown) {  // NOLINT(performance-unnecessary-value-param): its type
        try {
          if (thrown) std::rethrow_exception(thrown);
        } catch (const sequences::InputError& error) {
          PyErr_SetString(PyExc_ValueError, error.what());
        }
      });
  module.def("fit", &fit, py::arg("points"), py::arg("targets"), py::arg("curve"));
  module.def("plan", &plan, py::arg("sequence"), py::arg("words"));
  module.def("render", &render, py::arg("sequence"), py::arg("frame"), py::arg("words"));
  module.attr("version") = TALISMAN_VERSION;
}
