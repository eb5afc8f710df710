#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#pragma GCC target("avx512f,avx512dq,avx512vl,avx2,fma,prefer-vector-width=512")
#define W 8
#define NAME avx512
#include "core.h"
int roughcoat_has_avx512(void) { return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")
                                        && __builtin_cpu_supports("avx512vl"); }
#endif
