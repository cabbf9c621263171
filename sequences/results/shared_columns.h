// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Columns that a frame and a whole run have in common.

#include <utility>
#include <vector>

#include "sequences/pipeline/sprite_compression.h"
#include "sequences/results/columns.h"

namespace talisman::sequences {

/// The two halves of compression_columns: what is computed from what is stored, and that.
template <typename Row, typename Report>
std::vector<Column<Row>> computed_compression_columns(Report);
template <typename Row, typename Report>
std::vector<Column<Row>> stored_compression_columns(Report);

/// Of compressed sprites. `report` takes a row, const or not, and returns a CompressionReport by reference.
template <typename Row, typename Report>
std::vector<Column<Row>> compression_columns(Report report) {
  std::vector<Column<Row>> columns = computed_compression_columns<Row>(report);
  for (Column<Row>& column : stored_compression_columns<Row>(report)) columns.push_back(std::move(column));
  return columns;
}

template <typename Row, typename Report>
std::vector<Column<Row>> computed_compression_columns(Report) {
  const auto named = [](const char* name) { return std::string("compression_") + name; };
  const auto at = [](const char* name) { return std::string("compression/") + name; };
  return {
      computed<Row>(named("ratio"), at("ratio"), "", "original to compressed bytes; 1 if nothing was drawn",
                    [](const Row& r) { return Report{}(r).ratio(); }),
      computed<Row>(named("color_psnr_db"), at("color_psnr_db"), "dB", "of the colours; null: no error",
                    [](const Row& r) { return Report{}(r).error.color_psnr_db(); }),
      computed<Row>(named("alpha_psnr_db"), at("alpha_psnr_db"), "dB", "of the alphas; null: no error",
                    [](const Row& r) { return Report{}(r).error.alpha_psnr_db(); }),
      computed<Row>(named("cache_hit_rate"), at("cache_hit_rate"), "",
                    "share of the compositor's chunk reads that the modelled cache serves",
                    [](const Row& r) { return Report{}(r).cache.hit_rate(); })};
}

template <typename Row, typename Report>
std::vector<Column<Row>> stored_compression_columns(Report) {
  const auto named = [](const char* name) { return std::string("compression_") + name; };
  const auto at = [](const char* name) { return std::string("compression/") + name; };
  return {stored<Row>(
              named("sprites"), at("sprites"), "sprites", "drawn and compressed",
              [](auto& r) -> auto& { return Report{}(r).sprites; }),
          stored<Row>(
              named("original_bytes"), at("original_bytes"), "bytes", "of these before",
              [](auto& r) -> auto& { return Report{}(r).original_bytes; }),
          stored<Row>(
              named("compressed_bytes"), at("compressed_bytes"), "bytes", "and after",
              [](auto& r) -> auto& { return Report{}(r).compressed_bytes; }),
          stored<Row>(
              named("chunks"), at("chunks"), "32×32 chunks", "of these that are not clear",
              [](auto& r) -> auto& { return Report{}(r).chunks; }),
          stored<Row>(
              named("raw_chunks"), at("raw_chunks"), "32×32 chunks", "of them, kept as they are",
              [](auto& r) -> auto& { return Report{}(r).raw_chunks; }),
          stored<Row>(
              named("color_squared_error"), at("color_squared_error"), "",
              "sum over texels and channels, code values, weighted by alpha",
              [](auto& r) -> auto& { return Report{}(r).error.color_squared; }),
          stored<Row>(
              named("color_weight"), at("color_weight"), "", "sum of the weights",
              [](auto& r) -> auto& { return Report{}(r).error.color_weight; }),
          stored<Row>(
              named("alpha_squared_error"), at("alpha_squared_error"), "", "sum over texels, code values",
              [](auto& r) -> auto& { return Report{}(r).error.alpha_squared; }),
          stored<Row>(
              named("texels"), at("texels"), "texels", "of the chunks that are not clear",
              [](auto& r) -> auto& { return Report{}(r).error.texels; }),
          stored<Row>(
              named("cache_hits"), at("cache_hits"), "32×32 chunks", "found in the modelled cache",
              [](auto& r) -> auto& { return Report{}(r).cache.hits; }),
          stored<Row>(
              named("cache_misses"), at("cache_misses"), "32×32 chunks", "read and decompressed",
              [](auto& r) -> auto& { return Report{}(r).cache.misses; }),
          stored<Row>(
              named("cache_bytes_read"), at("cache_bytes_read"), "bytes", "compressed, read for these",
              [](auto& r) -> auto& { return Report{}(r).cache.bytes_read; })};
}

}  // namespace talisman::sequences
