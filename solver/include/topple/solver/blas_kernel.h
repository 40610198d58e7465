#pragma once
// Which kernels OpenBLAS runs, and how to get the right ones. OpenBLAS chooses them when it is loaded, by a table of
// the processors known when it was made: on a later one it may fall back to kernels that are several times slower
// (0.3.21 takes SSE3 kernels on Intel family 6 model 207: 14 instead of 50 GF/s a core). It reads OPENBLAS_CORETYPE
// only while it is loaded, so the variable must stand before the program starts.
#include <optional>
#include <string>

namespace topple::solver {

/// Name of the kernels in use ("SkylakeX", "Haswell", "Prescott", ...).
[[nodiscard]] std::string blas_kernel();

/// The value of OPENBLAS_CORETYPE with which this processor should run, chosen by its instruction set from a shipped
/// rule (never by timing: other kernels give other bits, and a replay must not depend on a clock). None when the
/// kernels in use are already those, or when the user has set the variable.
[[nodiscard]] std::optional<std::string> better_blas_kernel();

/// Starts the program again, once, with OPENBLAS_CORETYPE set when that helps; else ends the threads that OpenBLAS has
/// started when it was loaded: with nothing to do, each keeps a processor busy for some 20 ms before it sleeps, as long
/// as a small analysis takes. (OpenBLAS starts them anew when more than one thread is asked for later.) For programs
/// that own their main: call it first thing there, before other threads use BLAS. A library's host calls
/// better_blas_kernel() and decides. Does nothing where programs cannot replace themselves.
void prepare_blas(char** argv);

}  // namespace topple::solver
