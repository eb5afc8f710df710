/* What Python and the core share: as in library.py, in the same order. Tables of numbers that are summed over their
   columns are in blocks of 8 rows: `_blocks` of tables.py. LAYOUT changes with all that is here: library.py takes no
   core of another one. */
#include <stdint.h>
#define LAYOUT 6
enum { LOAD, RADIUS, DEPTH };               /* the control of a batch */
enum { DISC_CELL, POWER_LAW, SMOOTH, CELL };        /* its micro law */
/* A family of cells on the coated body (cells.py): these numbers, PIECES pieces an octave of 1 + kappa y with the
   polynomials of exp P and exp G, those of exp Q, and of 1 + kappa_r r with those of y/r. */
enum { kappa_, end_, top_, kappa_r_, end_r_, top_r_, slope_P_, bend_P_ = 9, settles_ = 12, slope_r_, at_Q_, at_r_,
       NUMBERS };
#define PIECES 32
#define ROW 8                               /* coefficients of a polynomial of P, G or Q; half as many of y/r */
enum { a_, P_, D_, p0_, p_max_, Ar_An_, A0_, dP_dD_, residual_, error_, profile_error_, SCALARS };
#define JUDGED 6                            /* the first of these are judged by their relative error */
/* Points between the nodes of a mesh: s, weights of 2 s ds, kappa, and tables (n columns, m rows) of the polynomials
   and of the displacement of the half-space (solver/rough/results.py). */
typedef struct { int64_t m; const double *s, *w, *kappa, *basis, *half_space; } Points;
/* A mesh of n nodes and the next finer one, `fine`. K (n + 1, n) has the row of the edge last. */
typedef struct {
    int64_t n;
    const double *s, *w, *K, *kappa, *at_edge;
    const double *fine_s, *fine_w, *fine_K;
    Points fine, more, between, profile;
} Mesh;
/* The operator of a layer on a mesh (solver/body/tables.py): a table `product` (M columns, (n + 1) n rows), or NULL,
   and the matrix is formed of J_rows (n + 1, G) and of tables of J and phi by G columns and of phi by n columns. */
typedef struct { const double *product, *J_rows, *J, *phi, *phi_columns; } Rows;
/* One octave of h/a and class of stiffness on a mesh: k (M,), spread (M, G), and J at the points between (G, m). */
typedef struct {
    int64_t few, all;
    const double *k, *spread;
    Rows own, fine;
    const double *J_fine, *J_more, *J_profile;
} Table;
typedef struct {
    int64_t size, stride, points, rungs;   /* stride: between the scalars of a case */
    int32_t control, law, layered, octaves, first_octave, steps;
    const int64_t *ladder;
    const double *value, *rtol, *p_star, *A_star, *beta, *ratio, *E, *C;
    const double *const *cells;             /* (size,), the family of each case, of the law CELL */
    const double *h, *m, *n, *bonded, *c1, *c2, *one_c1, *one_c2, *plus_c1, *one_c1c2;
    const int64_t *fixed;                   /* (size,), number of nodes, or 0: chosen by rtol */
    const double *shrink;                   /* (points,), s at a profile's radius over the s that is solved there */
    const int64_t *place;                   /* (points,), the column of p and lam of each of these */
    int64_t columns;                        /* of p and lam */
    double *scalars;                        /* (SCALARS, stride) */
    double *p, *lam;                        /* (size, columns) */
    int32_t *nodes, *iterations;            /* (size,); nodes 0: the case is handed back */
    const Mesh *(*mesh)(int64_t n);
    const Table *(*table)(int64_t n, int64_t octave, int64_t stiffness);
} Batch;
/* Loads at points of curves (sticking.h): P and its slope by the depth (curves, points), and derivatives by the other
   rows (others, curves, points) and by the logarithms of the four parts (4, curves, points). */
typedef struct { double *P, *slope, *by_rows, *by_parts; } Loads;
#define MOST_LENGTH 256
typedef struct {
    int64_t curves, points, length, others;
    double step;                            /* of the lattice of `length` points, at most MOST_LENGTH */
    const double *rows, *depth;             /* (1 + others, curves, 8, length), (curves, points) */
    Loads sticks, free;
    double *D_off, *D_least;                /* (curves,) */
} Sticking;
/* Sums over `waves` waves at points (waves.h): the constants of `size` bodies, and of each point its body, the end of
   its waves, the place, the layer's thickness and Poisson's ratio, the parts of antiplane waves that the interface
   returns and lets pass, and its row of windows. */
typedef struct {
    int64_t points, size, waves, thin, columns, fields, most, kind;
    double S, T;
    const int64_t *orders, *cases, *ends, *window;
    const double *r, *z, *h, *nu, *returned, *passed;
    const double *k, *p;                    /* (waves,), (size, waves) */
    const double *surface, *down, *up, *base;   /* (4, size, thin), (2, size, waves - thin) twice, (2, size, waves) */
    const double *states;                   /* (6, points, columns) of STATES, or 4 where there are no more */
    const double *f, *windows;              /* complex (size, waves), and (rows, columns); or NULL */
    double *sums;                           /* (6, fields, points) */
} Sums;
/* Boxes (boxes.h) of a place u, v, in which the stresses are models: values and derivatives by u, v, uu, uv, vv. */
typedef struct {
    int64_t tasks;
    const int64_t *functions;
    const double *models, *centre, *low, *high; /* (6, 4, tasks), (tasks, 2) each */
    double *places, *values;                /* (tasks, 2), (tasks,) */
} Boxes;
