#pragma once
// TOPPLE_VECTOR_VERSIONS before a function: one build for every processor. The compiler makes a version for each kind of
// vector, the loader takes the best.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define TOPPLE_VECTOR_VERSIONS __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define TOPPLE_VECTOR_VERSIONS
#endif
