// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/traces/trace_keys.h"

namespace talisman::sequences {

namespace {

const std::vector<std::pair<std::string, TraceFormat>> kFormats = {{"tum", TraceFormat::Tum},
                                                                   {"euroc", TraceFormat::Euroc},
                                                                   {"colmap", TraceFormat::Colmap},
                                                                   {"iwer", TraceFormat::Iwer},
                                                                   {"bvh", TraceFormat::Bvh}};

void read_trace_file(const YamlValue& value, TraceOptions& trace) try {
  trace.file = asset().read(value);
} catch (const InputError& error) {
  if (trace.otherwise.empty()) throw;
  trace.file = trace.otherwise;
  trace.missing = error.what();
}

}  // namespace

const Table<TraceOptions>& trace_keys() {
  using T = TraceOptions;
  static const Table<T> table =
      Table<T>("trace")
          .placed([](T& trace, const YamlValue& self) {
            trace.sequence_file = self.file();
            trace.line = self.line();
          })
          .key("otherwise", &T::otherwise, asset(), "",
               "of the same format: stands in where `file` is not there, which is said")
          .otherwise("none")
          .custom("file", asset().type, read_trace_file, "", "recorded poses")
          .required()
          .key("format", &T::format, choice(kFormats), "", "how they are written")
          .otherwise("as the name says: .bvh, .json iwer, images.txt colmap, .csv euroc, else tum")
          .key("joint", &T::joint, text(), "", "of bvh: whose pose it is")
          .key("fps", &T::fps, number(kPositive), "1/s",
               "of colmap, which has no times; of bvh, instead of its own")
          .key("start_s", &T::start_s, number(kNotNegative), "s",
               "how long after the first pose the sequence begins")
          .key("scale", &T::scale, number(kPositive), "m", "length of a unit of the file")
          .key("frame", &T::frame, choice<BodyFrame>({{"gl", BodyFrame::Gl}, {"opencv", BodyFrame::OpenCv}}),
               "", "axes of what is tracked: x right, y up, looks along -z; or y down, looks along z")
          .otherwise("`opencv` of tum, euroc and colmap, `gl` of iwer and bvh")
          .key("up", &T::up,
               choice<UpwardAxis>({{"y", UpwardAxis::Y}, {"z", UpwardAxis::Z}, {"-y", UpwardAxis::MinusY}}),
               "", "the axis of the file's world that points up")
          .key("resample", &T::resample,
               choice<Resampling>({{"slerp", Resampling::Slerp}, {"cubic", Resampling::Cubic}}), "",
               "between two poses: straight on, or with continuous speed")
          .key("jumps", &T::jumps, choice<Jumps>({{"keep", Jumps::Keep}, {"clip", Jumps::Clip}}), "",
               "single steps ten times as fast as those beside them: are said, or taken out");
  return table;
}

TraceFormat trace_format_from(const std::string& word) {
  std::vector<std::string> words;
  for (const auto& [name, format] : kFormats) {
    if (name == word) return format;
    words.push_back(name);
  }
  throw InputError("--format is '" + word + "', rule: one of " + joined(words));
}

}  // namespace talisman::sequences
