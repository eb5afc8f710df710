#define W 2                                     /* SSE2 on x86-64; what else a processor has for two numbers */
#define NAME sse2
#include "core.h"
int roughcoat_has_sse2(void) { return 1; }
/* What library.py compares with its own: a core that was built of other sources is not taken. */
int64_t roughcoat_layout(void) {
    int64_t number = LAYOUT, sizes[] = {sizeof(Batch), sizeof(Mesh), sizeof(Table), sizeof(Sticking), sizeof(Sums),
                                       sizeof(Boxes)};
    for (int i = 0; i < 6; i++) number = number * 512 + sizes[i];
    return number;
}
