/* SPDX-License-Identifier: MIT */
#include "double_imm.h"

#include <math.h>
#include <string.h>

#define AXES 3
#define MEASURED_MAX 6

/* ---- models ---------------------------------------------------------------------------------- */

static struct double_model model_of(const double transition[3][3], const double noise[3][3])
{
    struct double_model model = {.is_steady = transition[2][2] <= 0.0};
    for (int i = 0; i < DOUBLE_STATES; i++) {
        for (int j = i % AXES; j < DOUBLE_STATES; j += AXES) {
            model.transition.at[i][j] = transition[i / AXES][j / AXES];
            model.noise.at[i][j] = noise[i / AXES][j / AXES];
        }
    }
    return model;
}

struct double_model double_model_steady(double interval_s, const double input[2], double accel_mps2)
{
    double transition[3][3] = {{1.0, interval_s, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 0.0}};
    double noise[3][3] = {{0.0}};
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) {
            noise[i][j] = input[i] * input[j] * accel_mps2 * accel_mps2;
        }
    }
    return model_of((const double(*)[3])transition, (const double(*)[3])noise);
}

struct double_model double_model_noisy(double interval_s, double place_m2, double velocity_m2ps2)
{
    double transition[3][3] = {{1.0, interval_s, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 0.0}};
    double noise[3][3] = {{place_m2, 0.0, 0.0}, {0.0, velocity_m2ps2, 0.0}, {0.0, 0.0, 0.0}};
    return model_of((const double(*)[3])transition, (const double(*)[3])noise);
}

struct double_model double_model_singer(double interval_s, double keep, double step_mps2)
{
    double half_s2 = interval_s * interval_s / 2.0;
    double transition[3][3] = {
        {1.0, interval_s, half_s2}, {0.0, 1.0, interval_s}, {0.0, 0.0, keep}};
    double of_step[3] = {half_s2, interval_s, 1.0}, noise[3][3];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            noise[i][j] = of_step[i] * of_step[j] * step_mps2 * step_mps2;
        }
    }
    return model_of((const double(*)[3])transition, (const double(*)[3])noise);
}

/* ---- one filter ------------------------------------------------------------------------------ */

/* F P, or P F^T; F couples no axes. */
static struct double_matrix moved(const struct double_matrix *transition,
                                  const struct double_matrix *of, int is_from_right)
{
    struct double_matrix product = {.at = {{0.0}}};
    for (int i = 0; i < DOUBLE_STATES; i++) {
        for (int k = i % AXES; k < DOUBLE_STATES; k += AXES) {
            for (int j = 0; j < DOUBLE_STATES; j++) {
                if (is_from_right) {
                    product.at[j][i] += of->at[j][k] * transition->at[i][k];
                } else {
                    product.at[i][j] += transition->at[i][k] * of->at[k][j];
                }
            }
        }
    }
    return product;
}

void double_gaussian_predict(struct double_gaussian *gaussian, const struct double_model *model,
                             const double shift[DOUBLE_STATES])
{
    struct double_matrix half = moved(&model->transition, &gaussian->covariance, 0);
    double mean[DOUBLE_STATES];
    gaussian->covariance = moved(&model->transition, &half, 1);
    for (int i = 0; i < DOUBLE_STATES; i++) {
        mean[i] = shift != NULL ? shift[i] : 0.0;
        for (int j = 0; j < DOUBLE_STATES; j++) {
            mean[i] += model->transition.at[i][j] * gaussian->mean[j];
            gaussian->covariance.at[i][j] += model->noise.at[i][j];
        }
    }
    memcpy(gaussian->mean, mean, sizeof mean);
}

/* Inverse by Gauss and Jordan; returns ln det. The matrix is positive definite: no pivoting. */
static double invert(size_t size, double matrix[MEASURED_MAX][MEASURED_MAX],
                     double inverse[MEASURED_MAX][MEASURED_MAX])
{
    double log_det = 0.0;
    for (size_t i = 0; i < size; i++) {
        for (size_t j = 0; j < size; j++) {
            inverse[i][j] = i == j ? 1.0 : 0.0;
        }
    }
    for (size_t k = 0; k < size; k++) {
        double pivot = matrix[k][k];
        log_det += log(pivot);
        for (size_t j = 0; j < size; j++) {
            matrix[k][j] /= pivot;
            inverse[k][j] /= pivot;
        }
        for (size_t i = 0; i < size; i++) {
            double factor = matrix[i][k];
            for (size_t j = 0; j < size && i != k; j++) {
                matrix[i][j] -= factor * matrix[k][j];
                inverse[i][j] -= factor * inverse[k][j];
            }
        }
    }
    return log_det;
}

struct innovation {
    double off[MEASURED_MAX];
    double inverse[MEASURED_MAX][MEASURED_MAX]; /* of its covariance */
    double log_det, distance2;
};

static struct innovation innovation_of(const struct double_gaussian *gaussian,
                                       const struct double_measured *measured)
{
    struct innovation innovation = {.distance2 = 0.0};
    double covariance[MEASURED_MAX][MEASURED_MAX] = {{0.0}};
    for (size_t i = 0; i < measured->size; i++) {
        innovation.off[i] = measured->value[i] - gaussian->mean[i];
        for (size_t j = 0; j < measured->size; j++) {
            covariance[i][j] = gaussian->covariance.at[i][j] + measured->covariance[i][j];
        }
    }
    innovation.log_det = invert(measured->size, covariance, innovation.inverse);
    for (size_t i = 0; i < measured->size; i++) {
        for (size_t j = 0; j < measured->size; j++) {
            innovation.distance2 +=
                innovation.off[i] * innovation.inverse[i][j] * innovation.off[j];
        }
    }
    return innovation;
}

double double_gaussian_distance2(const struct double_gaussian *gaussian,
                                 const struct double_measured *measured, double *log_det)
{
    struct innovation innovation = innovation_of(gaussian, measured);
    if (log_det != NULL) {
        *log_det = innovation.log_det;
    }
    return innovation.distance2;
}

static void update_with(struct double_gaussian *gaussian, size_t size,
                        const struct innovation *innovation)
{
    const struct double_matrix old = gaussian->covariance;
    for (size_t i = 0; i < DOUBLE_STATES; i++) {
        double gain[MEASURED_MAX] = {0.0};
        for (size_t k = 0; k < size; k++) {
            for (size_t j = 0; j < size; j++) {
                gain[k] += old.at[i][j] * innovation->inverse[j][k];
            }
            gaussian->mean[i] += gain[k] * innovation->off[k];
        }
        for (size_t j = 0; j < DOUBLE_STATES; j++) {
            for (size_t k = 0; k < size; k++) {
                gaussian->covariance.at[i][j] -= gain[k] * old.at[k][j];
            }
        }
    }
}

static void make_symmetric(struct double_matrix *matrix)
{
    for (int i = 0; i < DOUBLE_STATES; i++) {
        for (int j = 0; j < i; j++) {
            matrix->at[i][j] = matrix->at[j][i] = (matrix->at[i][j] + matrix->at[j][i]) / 2.0;
        }
    }
}

void double_gaussian_update(struct double_gaussian *gaussian,
                            const struct double_measured *measured)
{
    struct innovation innovation = innovation_of(gaussian, measured);
    update_with(gaussian, measured->size, &innovation);
    make_symmetric(&gaussian->covariance);
}

/* ---- several --------------------------------------------------------------------------------- */

static struct double_gaussian mean_of(const struct double_gaussian *parts, const double *weights,
                                      size_t count)
{
    struct double_gaussian mean = {.mean = {0.0}};
    for (size_t m = 0; m < count; m++) {
        for (int i = 0; i < DOUBLE_STATES; i++) {
            mean.mean[i] += weights[m] * parts[m].mean[i];
        }
    }
    for (size_t m = 0; m < count; m++) {
        for (int i = 0; i < DOUBLE_STATES; i++) {
            for (int j = 0; j < DOUBLE_STATES; j++) {
                double spread =
                    (parts[m].mean[i] - mean.mean[i]) * (parts[m].mean[j] - mean.mean[j]);
                mean.covariance.at[i][j] += weights[m] * (parts[m].covariance.at[i][j] + spread);
            }
        }
    }
    return mean;
}

static void stop_acceleration(struct double_gaussian *gaussian)
{
    for (int i = 2 * AXES; i < DOUBLE_STATES; i++) {
        gaussian->mean[i] = 0.0;
        for (int j = 0; j < DOUBLE_STATES; j++) {
            gaussian->covariance.at[i][j] = gaussian->covariance.at[j][i] = 0.0;
        }
    }
}

void double_imm_start(struct double_imm *imm, const struct double_gaussian *start)
{
    for (size_t m = 0; m < imm->num_models; m++) {
        imm->mode[m] = *start;
        imm->probability[m] = 1.0 / (double)imm->num_models;
        if (imm->model[m].is_steady) {
            stop_acceleration(&imm->mode[m]);
        }
    }
}

/* Probability of going from one model to another. */
static double passage(const struct double_imm *imm, size_t from, size_t to)
{
    if (imm->num_models == 1) {
        return 1.0;
    }
    return from == to ? imm->stay : (1.0 - imm->stay) / (double)(imm->num_models - 1);
}

void double_imm_predict(struct double_imm *imm)
{
    struct double_gaussian mixed[DOUBLE_MODELS_MAX];
    double predicted[DOUBLE_MODELS_MAX];
    for (size_t to = 0; to < imm->num_models; to++) {
        double weights[DOUBLE_MODELS_MAX];
        predicted[to] = 0.0;
        for (size_t from = 0; from < imm->num_models; from++) {
            weights[from] = passage(imm, from, to) * imm->probability[from];
            predicted[to] += weights[from];
        }
        for (size_t from = 0; from < imm->num_models; from++) {
            weights[from] /= predicted[to];
        }
        mixed[to] = mean_of(imm->mode, weights, imm->num_models);
    }
    for (size_t m = 0; m < imm->num_models; m++) {
        imm->mode[m] = mixed[m];
        imm->probability[m] = predicted[m];
        double_gaussian_predict(&imm->mode[m], &imm->model[m], NULL);
    }
}

void double_imm_update(struct double_imm *imm, const struct double_measured *measured)
{
    double log_likelihood[DOUBLE_MODELS_MAX], best = -INFINITY, sum = 0.0;
    for (size_t m = 0; m < imm->num_models; m++) {
        struct innovation innovation = innovation_of(&imm->mode[m], measured);
        log_likelihood[m] = -(innovation.distance2 + innovation.log_det) / 2.0;
        best = fmax(best, log_likelihood[m]);
        update_with(&imm->mode[m], measured->size, &innovation);
        make_symmetric(&imm->mode[m].covariance);
    }
    for (size_t m = 0; m < imm->num_models; m++) {
        imm->probability[m] *= exp(log_likelihood[m] - best);
        sum += imm->probability[m];
    }
    for (size_t m = 0; m < imm->num_models; m++) {
        imm->probability[m] /= sum;
    }
}

void double_imm_estimate(const struct double_imm *imm, struct double_gaussian *estimate)
{
    *estimate = mean_of(imm->mode, imm->probability, imm->num_models);
}
