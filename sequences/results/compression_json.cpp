// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/compression_json.h"

#include "sequences/files/number_text.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

/// Calls visit(name, value) for every sum of the report, named once for writing and reading.
template <typename Report, typename Visit>
void for_each_sum(Report& report, const Visit& visit) {
  visit("sprites", report.sprites);
  visit("original_bytes", report.original_bytes);
  visit("compressed_bytes", report.compressed_bytes);
  visit("chunks", report.chunks);
  visit("raw_chunks", report.raw_chunks);
  visit("color_squared_error", report.error.color_squared);
  visit("color_weight", report.error.color_weight);
  visit("alpha_squared_error", report.error.alpha_squared);
  visit("texels", report.error.texels);
  visit("cache_hits", report.cache.hits);
  visit("cache_misses", report.cache.misses);
  visit("cache_bytes_read", report.cache.bytes_read);
  visit("compress_ms", report.compress_ms);
}

}  // namespace

Json compression_json(const CompressionReport& report) {
  Json json = {{"ratio", report.ratio()},
               {"color_psnr_db", number_or_null(report.error.color_psnr_db())},
               {"alpha_psnr_db", number_or_null(report.error.alpha_psnr_db())},
               {"cache_hit_rate", report.cache.hit_rate()}};
  for_each_sum(report, [&json](const char* name, const auto& value) { json[name] = value; });
  return json;
}

CompressionReport compression_from_json(const Json& json) {
  CompressionReport report;
  for_each_sum(report, [&json](const char* name, auto& value) { json.at(name).get_to(value); });
  return report;
}

}  // namespace talisman::sequences
