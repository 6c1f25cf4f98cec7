#pragma once

#include <string_view>

#include <pose_generated.h>

#include "engine/wind/wind_state.hpp"
#include "engine/wire/parameters.hpp"

// For the .cpp files of this folder only: the code that flatc generates from pose.fbs.

namespace yuragi::wire {

namespace fb = yuragi::stream;

inline fb::Wind to_schema(const wind::State& state) {
  return fb::Wind(static_cast<float>(state.wind.u_m_s), static_cast<float>(state.wind.v_m_s),
                  static_cast<float>(state.live_weight), static_cast<float>(state.reading_age_s),
                  static_cast<fb::WindSource>(state.source));
}

inline fb::WindPlace place_to_schema(const wind::State& state) {
  return fb::WindPlace(static_cast<float>(state.upwind_m), static_cast<float>(state.to_middle_s),
                       state.is_place_configured);
}

/// `text`, cut to the maximum length that decode() accepts, at the start of a UTF-8 character.
flatbuffers::Offset<flatbuffers::String> add_text(flatbuffers::FlatBufferBuilder& builder, std::string_view text);

flatbuffers::Offset<fb::ParameterCommand> add_parameters(flatbuffers::FlatBufferBuilder& builder,
                                                         const ParameterCommand& command);
flatbuffers::Offset<fb::ParameterReport> add_parameters(flatbuffers::FlatBufferBuilder& builder,
                                                        const ParameterReport& report);

}  // namespace yuragi::wire
