#define W 2                                     /* SSE2 on x86-64; what else a processor has for two numbers */
#define NAME sse2
#include "core.h"
int roughcoat_has_sse2(void) { return 1; }
