// SPDX-License-Identifier: MIT
/*
 * assimp_api.h - functions of libassimp, which is loaded on request
 *
 * Threads:   one
 * Errors:    no libassimp, or one of another version; a build without its
 *            headers
 */
#ifndef GLIM_ASSIMP_API_H
#define GLIM_ASSIMP_API_H

#include "base/error.h"

#define ASSIMP_PACKAGE "libassimp5"

/* A build can do without the headers, and then reads no such formats. */
#if __has_include(<assimp/cimport.h>)
#define HAS_ASSIMP 1
#else
#define HAS_ASSIMP 0
#endif

#if HAS_ASSIMP

#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#define ASSIMP_FUNCTIONS(F)       \
    F(ImportFileExWithProperties) \
    F(CreatePropertyStore)        \
    F(SetImportPropertyInteger)   \
    F(GetErrorString)             \
    F(GetMaterialColor)           \
    F(GetMaterialFloatArray)      \
    F(GetMaterialString)          \
    F(GetMaterialTexture)

struct assimp_api {
#define MEMBER(name) __typeof__(&ai##name) name;
    ASSIMP_FUNCTIONS(MEMBER)
#undef MEMBER
};

#endif

/* Returns the functions, or NULL. */
const struct assimp_api *assimp_api_open(struct error *err);

#endif
