/* The compiled core: Newton's method for many cases at once, the loads of curves with adhesion, and
   sums over waves and the searches that need them. The numpy path
   (solver/rough) is its reference, and says what is computed and why. Here each case has a lane of a vector and meets
   no number of another case: so it has the same bits in any company. The files sse2.c, avx2.c and avx512.c compile this
   for their vectors of W numbers; Python takes the widest that the processor has (solver/compiled/library.py). */
#include "batch.h"
#include <stdlib.h>
#include <string.h>
#include "lanes.h"
#include "laws.h"
#include "newton.h"
#include "cases.h"
#include "run.h"
#include "sticking.h"
#include "waves.h"
#include "boxes.h"

#define SOLVE_(name) roughcoat_##name
#define SOLVE(name) SOLVE_(name)
int SOLVE(NAME)(const Batch *b, int64_t most) { return solve(b, most); }
#define STICKING_(name) roughcoat_sticking_##name
#define STICKING(name) STICKING_(name)
void STICKING(NAME)(const Sticking *s) { for (int64_t i = 0; i < s->curves; i++) of_curve(s, i); }
#define SUMS_(name) roughcoat_sums_##name
#define SUMS(name) SUMS_(name)
void SUMS(NAME)(const Sums *s) { sum_waves(s); }
#define BOXES_(name) roughcoat_boxes_##name
#define BOXES(name) BOXES_(name)
void BOXES(NAME)(const Boxes *s) { highest_in_boxes(s); }
