// Makes one header readable by GLSL and C++: types in C++ live in surefield::glsl, in scalar layout.
#ifndef SUREFIELD_SHARED_LANGUAGE_H
#define SUREFIELD_SHARED_LANGUAGE_H

#ifdef __cplusplus

#include <array>
#include <cstdint>
#include <iterator>
#include <span>

#include "engine/gpu/glsl_types.h"
#include "engine/gpu/pass.h"

#define SUREFIELD_STRING_(text) #text
#define SUREFIELD_STRING(text) SUREFIELD_STRING_(text)
#define SHARED_CONST inline constexpr
#define SHARED_TYPES_BEGIN namespace surefield::glsl {
#define SHARED_TYPES_END }

#else

#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_shuffle : require

#define SHARED_CONST const
#define SHARED_TYPES_BEGIN
#define SHARED_TYPES_END

#endif

#endif
