/* static_solver.h: small linear statics on the element kernels, for tests: stiffness by differences of strain and force with a linear elastic law, banded Cholesky,
 * eigenvalues of small symmetric matrices. Plane strain. */
#ifndef AB_STATIC_SOLVER_H
#define AB_STATIC_SOLVER_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fem/element.h"

enum { MOST_DOFS = 2 * FEM_NODES };

typedef struct static_model {
    const fem_element *element;
    fem_elastic elastic;
    bool f_bar;
    double hourglass;
    size_t nodes, elements;
    double (*x)[2];         /* m */
    uint32_t *connectivity; /* element->nodes an element */
    bool (*held)[2];        /* true: u is given */
    double (*u)[2];         /* displacement */
    double (*load)[2];      /* N */
    double *stiffness;      /* (2 nodes)^2 an element */
    double *factor;         /* Cholesky: row i holds columns i - band .. i */
    size_t band;
} static_model;

static inline fem_elastic elastic_of(double modulus, double nu, double density) {
    return (fem_elastic){modulus * nu / ((1 + nu) * (1 - 2 * nu)), modulus / (2 * (1 + nu)), density};
}

/* sigma = C : sym H, at every Gauss point. */
static inline void linear_stress(const fem_element *element, const fem_elastic *elastic, fem_block *block) {
    for (int q = 0; q < element->gauss; q++)
        for (int l = 0; l < 8; l++) {
            const double xx = block->h[q][0][l], yy = block->h[q][3][l], pressure = elastic->lambda * (xx + yy);
            block->stress[q][0][l] = pressure + 2 * elastic->mu * xx;
            block->stress[q][1][l] = pressure + 2 * elastic->mu * yy;
            block->stress[q][2][l] = pressure;
            block->stress[q][3][l] = elastic->mu * (block->h[q][1][l] + block->h[q][2][l]);
        }
}

/* From rest at `x` to x + u: strain, stress; then the forces, at the end or (small) still at the beginning. */
static inline void elastic_step(const static_model *m, const double (*x)[8], const double (*u)[8], bool small, fem_block *block) {
    memset(block, 0, sizeof *block);
    for (int k = 0; k < 2 * m->element->nodes; k++)
        for (int l = 0; l < 8; l++) {
            block->start[k][l] = x[k][l];
            block->end[k][l] = x[k][l] + u[k][l];
        }
    m->element->strain(block, &m->elastic, m->f_bar, m->hourglass);
    linear_stress(m->element, &m->elastic, block);
    if (small) memcpy(block->end, block->start, sizeof block->end);
    m->element->force(block, m->f_bar);
}

/* Stiffness of eight elements about rest: k[i][j][lane], by central differences, exact where the forces are linear in u (those of q6 are, but for the turn of its modes). */
static inline void element_stiffness(const static_model *m, const double (*x)[8], double (*k)[MOST_DOFS][8]) {
    const int n = 2 * m->element->nodes;
    double size = 0;
    for (int i = 2; i < 8; i++) size = fmax(size, fabs(x[i][0] - x[i % 2][0]));
    const double step = 1e-6 * size;
    for (int j = 0; j < n; j++) {
        fem_block plus, minus;
        double u[MOST_DOFS][8] = {{0}};
        for (int l = 0; l < 8; l++) u[j][l] = step;
        elastic_step(m, x, u, true, &plus);
        for (int l = 0; l < 8; l++) u[j][l] = -step;
        elastic_step(m, x, u, true, &minus);
        for (int i = 0; i < n; i++)
            for (int l = 0; l < 8; l++) k[i][j][l] = (plus.force[i][l] - minus.force[i][l]) / (2 * step);
    }
}

static inline size_t model_node(const static_model *m, size_t e, int a) {
    return m->connectivity[e * (size_t)m->element->nodes + (size_t)a];
}

/* Rows of a field on the nodes for elements e .. e + 7; lanes past the last repeat it. */
static inline void model_gather(const static_model *m, size_t e, const double (*field)[2], double (*rows)[8]) {
    for (int l = 0; l < 8; l++) {
        const size_t which = e + (size_t)l < m->elements ? e + (size_t)l : m->elements - 1;
        for (int a = 0; a < m->element->nodes; a++)
            for (int c = 0; c < 2; c++) rows[2 * a + c][l] = field[model_node(m, which, a)][c];
    }
}

static inline static_model *model_create(ab_element_type type, fem_elastic elastic, size_t nodes, size_t elements) {
    static_model *m = calloc(1, sizeof *m);
    m->element = fem_element_of(type);
    m->elastic = elastic;
    m->hourglass = 1;
    m->nodes = nodes;
    m->elements = elements;
    m->x = calloc(nodes, sizeof *m->x);
    m->u = calloc(nodes, sizeof *m->u);
    m->load = calloc(nodes, sizeof *m->load);
    m->held = calloc(nodes, sizeof *m->held);
    m->connectivity = calloc(elements * (size_t)m->element->nodes, sizeof *m->connectivity);
    return m;
}

static inline void model_destroy(static_model *m) {
    free(m->x), free(m->u), free(m->load), free(m->held), free(m->connectivity), free(m->stiffness), free(m->factor), free(m);
}

/* nx x ny elements on the unit square, numbered up the columns; a bilinear map of four corners (counter-clockwise) places them. */
static inline static_model *model_quadrilateral(ab_element_type type, fem_elastic elastic, size_t nx, size_t ny,
                                                const double corner[4][2]) {
    const bool eight = fem_element_of(type)->nodes == 8;
    const size_t step = eight ? 2 : 1, columns = step * nx + 1, rows = step * ny + 1;
    uint32_t *number = calloc(columns * rows, sizeof *number);
    size_t count = 0;
    for (size_t i = 0; i < columns; i++)
        for (size_t j = 0; j < rows; j++)
            if (!eight || i % 2 == 0 || j % 2 == 0) number[i * rows + j] = (uint32_t)count++;
    static_model *m = model_create(type, elastic, count, nx * ny);
    for (size_t i = 0; i < columns; i++)
        for (size_t j = 0; j < rows; j++) {
            if (eight && i % 2 == 1 && j % 2 == 1) continue;
            double n[4];
            fem_shape(4, 2.0 * (double)i / (double)(columns - 1) - 1, 2.0 * (double)j / (double)(rows - 1) - 1, n);
            for (int c = 0; c < 2; c++)
                for (int a = 0; a < 4; a++) m->x[number[i * rows + j]][c] += n[a] * corner[a][c];
        }
    static const size_t place[8][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 0}, {2, 1}, {1, 2}, {0, 1}};
    for (size_t e = 0; e < nx * ny; e++)
        for (int a = 0; a < m->element->nodes; a++)
            m->connectivity[e * (size_t)m->element->nodes + (size_t)a] =
                number[(e / ny * step + place[a][0] * step / 2) * rows + e % ny * step + place[a][1] * step / 2];
    free(number);
    return m;
}

/* Internal forces at u, large displacements. */
static inline void model_forces(const static_model *m, double (*force)[2]) {
    memset(force, 0, m->nodes * sizeof *force);
    for (size_t e = 0; e < m->elements; e += 8) {
        double x[MOST_DOFS][8], u[MOST_DOFS][8];
        fem_block block;
        model_gather(m, e, (const double(*)[2])m->x, x);
        model_gather(m, e, (const double(*)[2])m->u, u);
        elastic_step(m, (const double(*)[8])x, (const double(*)[8])u, false, &block);
        for (size_t l = 0; l < 8 && e + l < m->elements; l++)
            for (int a = 0; a < m->element->nodes; a++)
                for (int c = 0; c < 2; c++) force[model_node(m, e + l, a)][c] += block.force[2 * a + c][l];
    }
}

/* Stiffness of all elements and its Cholesky factor; dofs that are held have a 1 on the diagonal. */
static inline void model_factor(static_model *m) {
    const int n = 2 * m->element->nodes;
    const size_t size = 2 * m->nodes;
    m->stiffness = calloc(m->elements * (size_t)(n * n), sizeof(double));
    double(*k)[MOST_DOFS][8] = calloc(MOST_DOFS, sizeof *k);
    for (size_t e = 0; e < m->elements; e += 8) {
        double x[MOST_DOFS][8];
        model_gather(m, e, (const double(*)[2])m->x, x);
        element_stiffness(m, (const double(*)[8])x, k);
        for (size_t l = 0; l < 8 && e + l < m->elements; l++)
            for (int i = 0; i < n; i++)
                for (int j = 0; j < n; j++) m->stiffness[(e + l) * (size_t)(n * n) + (size_t)(i * n + j)] = k[i][j][l];
    }
    free(k);
    for (size_t e = 0; e < m->elements; e++)
        for (int a = 0; a < m->element->nodes; a++)
            for (int b = 0; b < m->element->nodes; b++) {
                const size_t p = model_node(m, e, a), q = model_node(m, e, b);
                if (p >= q && 2 * (p - q) + 1 > m->band) m->band = 2 * (p - q) + 1;
            }
    const size_t width = m->band + 1;
    m->factor = calloc(size * width, sizeof(double));
#define AT(i, j) m->factor[(i)*width + (j) + m->band - (i)]
    for (size_t e = 0; e < m->elements; e++)
        for (int i = 0; i < n; i++)
            for (int j = 0; j < n; j++) {
                const size_t p = 2 * model_node(m, e, i / 2) + (size_t)(i % 2), q = 2 * model_node(m, e, j / 2) + (size_t)(j % 2);
                if (p < q || m->held[p / 2][p % 2] || m->held[q / 2][q % 2]) continue;
                AT(p, q) += m->stiffness[e * (size_t)(n * n) + (size_t)(i * n + j)];
            }
    for (size_t i = 0; i < size; i++) {
        if (m->held[i / 2][i % 2]) AT(i, i) = 1;
        const size_t first = i > m->band ? i - m->band : 0;
        for (size_t j = first; j <= i; j++) {
            const size_t begin = j > m->band && j - m->band > first ? j - m->band : first;
            const double *a = &AT(i, begin), *b = &AT(j, begin);
            double sum = AT(i, j);
            double part[4] = {0};
            size_t t = 0;
            for (; t + 4 <= j - begin; t += 4)
                for (int w = 0; w < 4; w++) part[w] += a[t + (size_t)w] * b[t + (size_t)w];
            for (; t < j - begin; t++) part[0] += a[t] * b[t];
            sum -= (part[0] + part[1]) + (part[2] + part[3]);
            if (i == j) assert_true(sum > 0);
            AT(i, j) = i == j ? sqrt(sum) : sum / AT(j, j);
        }
    }
#undef AT
}

/* u += K^-1 r on the dofs that are not held. */
static inline void model_correct(static_model *m, double (*residual)[2]) {
    const size_t size = 2 * m->nodes, width = m->band + 1;
    double *r = residual[0];
    for (size_t i = 0; i < size; i++) {
        if (m->held[i / 2][i % 2]) r[i] = 0;
        for (size_t j = i > m->band ? i - m->band : 0; j < i; j++) r[i] -= m->factor[i * width + j + m->band - i] * r[j];
        r[i] /= m->factor[i * width + m->band];
    }
    for (size_t i = size; i-- > 0;) {
        r[i] /= m->factor[i * width + m->band];
        for (size_t j = i > m->band ? i - m->band : 0; j < i; j++) r[j] -= m->factor[i * width + j + m->band - i] * r[i];
    }
    for (size_t i = 0; i < size; i++) m->u[i / 2][i % 2] += r[i];
}

/* Small displacements: K u = load, with the values of u that are held. */
static inline void model_solve(static_model *m) {
    const int n = 2 * m->element->nodes;
    model_factor(m);
    double(*r)[2] = calloc(m->nodes, sizeof *r);
    memcpy(r, m->load, m->nodes * sizeof *r);
    for (size_t e = 0; e < m->elements; e++)
        for (int i = 0; i < n; i++)
            for (int j = 0; j < n; j++)
                r[model_node(m, e, i / 2)][i % 2] -=
                    m->stiffness[e * (size_t)(n * n) + (size_t)(i * n + j)] * m->u[model_node(m, e, j / 2)][j % 2];
    model_correct(m, r);
    free(r);
}

/* Eigenvalues of a symmetric matrix, ascending (Jacobi's rotations). */
static inline void symmetric_eigenvalues(int n, double (*a)[MOST_DOFS], double *value) {
    for (int sweep = 0; sweep < 60; sweep++)
        for (int p = 0; p < n; p++)
            for (int q = p + 1; q < n; q++) {
                if (fabs(a[p][q]) < 1e-300) continue;
                const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
                const double t = (theta >= 0 ? 1 : -1) / (fabs(theta) + sqrt(theta * theta + 1)), c = 1 / sqrt(t * t + 1), s = t * c;
                for (int k = 0; k < n; k++) {
                    const double x = a[k][p], y = a[k][q];
                    a[k][p] = c * x - s * y;
                    a[k][q] = s * x + c * y;
                }
                for (int k = 0; k < n; k++) {
                    const double x = a[p][k], y = a[q][k];
                    a[p][k] = c * x - s * y;
                    a[q][k] = s * x + c * y;
                }
            }
    for (int i = 0; i < n; i++) value[i] = a[i][i];
    for (int i = 1; i < n; i++)
        for (int j = i; j > 0 && value[j] < value[j - 1]; j--) {
            const double swap = value[j];
            value[j] = value[j - 1];
            value[j - 1] = swap;
        }
}

#endif
