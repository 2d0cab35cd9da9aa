/* What zelus needs of PETSc, in terms that do not change with its version: numbers, arrays, and texts of options.
 *
 * Every function gives 0 or PETSc's error code, of which zp_message() then tells the text. All that take a solver or a
 * communicator are collective. Sizes of PETSc's own types stay in this file. */

#include <petscksp.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static char first_message[2048];

static PetscErrorCode keep_message(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code,
                                   PetscErrorType type, const char *message, void *context)
{
  (void)comm, (void)line, (void)file, (void)context;
  if (type == PETSC_ERROR_INITIAL && !first_message[0]) {
    const char *text = NULL;
    PetscErrorMessage(code, &text, NULL);
    snprintf(first_message, sizeof first_message, "%s: %s: %s", function ? function : "PETSc", text ? text : "error",
             message ? message : "");
  }
  return code;
}

const char *zp_message(void) { return first_message; }

static int started_here = 0;

int zp_start(void)
{
  PetscBool running = PETSC_FALSE;
  first_message[0] = 0;
  if (PetscInitialized(&running)) return 1;
  if (running) return 0;
  /* a signal or an error is the program's to report, never PETSc's to abort on */
  char *words[] = {"zelus", "-no_signal_handler", "-skip_petscrc", NULL};
  char **arguments = words;
  int count = 3;
  PetscErrorCode code = PetscInitialize(&count, &arguments, NULL, NULL);
  if (code) return (int)code;
  started_here = 1;
  return (int)PetscPushErrorHandler(keep_message, NULL);
}

int zp_end(void)
{
  if (!started_here) return 0;
  started_here = 0;
  PetscPopErrorHandler();
  return (int)PetscFinalize();
}

const void *zp_world(void) { return &PETSC_COMM_WORLD; }

int zp_rank_and_size(const void *comm, int *rank, int *size)
{
  return MPI_Comm_rank(*(const MPI_Comm *)comm, rank) || MPI_Comm_size(*(const MPI_Comm *)comm, size);
}

/* The largest of what all ranks give. */
int zp_largest(const void *comm, int64_t own, int64_t *largest)
{
  return MPI_Allreduce(&own, largest, 1, MPI_INT64_T, MPI_MAX, *(const MPI_Comm *)comm);
}

/* The sum over the ranks before this one, and over all. */
int zp_count(const void *comm, int64_t own, int64_t *before, int64_t *all)
{
  int64_t end = 0;
  int code = MPI_Scan(&own, &end, 1, MPI_INT64_T, MPI_SUM, *(const MPI_Comm *)comm);
  *before = end - own;
  return code || MPI_Allreduce(&own, all, 1, MPI_INT64_T, MPI_SUM, *(const MPI_Comm *)comm);
}

/* `count` numbers of every rank, one rank after another. */
int zp_gather(const void *comm, const double *own, int count, double *all)
{
  return MPI_Allgather(own, count, MPI_DOUBLE, all, count, MPI_DOUBLE, *(const MPI_Comm *)comm);
}

typedef struct {
  PetscOptions options;
  Mat matrix;
  KSP solver;
  Vec rhs, answer, residual, correction;
  double norm; /* Frobenius norm of the matrix; negative until it is needed */
} zp_solver;

typedef struct {
  double rhs_norm, residual_norm, answer_norm, matrix_norm;
  double seconds_setup, seconds_solve;
  int64_t iterations, refinements, null_pivots, factor_error, factor_detail;
  int reason;     /* of PETSc: positive when it believes in the answer */
  int pc_failed;  /* whether the factorisation or preconditioner failed */
} zp_report;

static PetscErrorCode insert_options(zp_solver *s, const char *text)
{
  PetscFunctionBegin;
  PetscCall(PetscOptionsCreate(&s->options));
  PetscCall(PetscOptionsInsertString(s->options, text));
  PetscFunctionReturn(0);
}

static PetscErrorCode make_solver(zp_solver *s)
{
  PetscFunctionBegin;
  PetscCall(KSPCreate(PetscObjectComm((PetscObject)s->matrix), &s->solver));
  PetscCall(KSPSetOperators(s->solver, s->matrix, s->matrix));
  PetscCall(KSPSetFromOptions(s->solver));
  PetscFunctionReturn(0);
}

static PetscErrorCode create(zp_solver *s, MPI_Comm comm, int64_t rows, const int64_t *starts, const int64_t *columns,
                             const double *values, int symmetry, int block, const char *options)
{
  PetscInt *i, *j;
  PetscFunctionBegin;
  PetscCheck(sizeof(PetscScalar) == sizeof(double), comm, PETSC_ERR_SUP, "PETSc must be built for real doubles");
  PetscCall(PetscMalloc2(rows + 1, &i, starts[rows], &j));
  for (int64_t k = 0; k <= rows; k++) i[k] = (PetscInt)starts[k];
  for (int64_t k = 0; k < starts[rows]; k++) j[k] = (PetscInt)columns[k];
  PetscCall(insert_options(s, options));
  PetscCall(MatCreate(comm, &s->matrix));
  PetscCall(MatSetSizes(s->matrix, (PetscInt)rows, (PetscInt)rows, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetBlockSize(s->matrix, block));
  PetscCall(MatSetType(s->matrix, MATMPIAIJ));
  PetscCall(MatMPIAIJSetPreallocationCSR(s->matrix, i, j, values));
  PetscCall(PetscFree2(i, j));
  if (symmetry > 0) {
    PetscCall(MatSetOption(s->matrix, MAT_SYMMETRIC, PETSC_TRUE));
    PetscCall(MatSetOption(s->matrix, MAT_SYMMETRY_ETERNAL, PETSC_TRUE));
  }
  if (symmetry > 1) PetscCall(MatSetOption(s->matrix, MAT_SPD, PETSC_TRUE));
  PetscCall(MatCreateVecs(s->matrix, &s->rhs, &s->answer));
  PetscCall(VecDuplicate(s->rhs, &s->residual));
  PetscCall(VecDuplicate(s->rhs, &s->correction));
  PetscFunctionReturn(0);
}

void zp_destroy(zp_solver *s)
{
  PetscBool ended = PETSC_FALSE;
  /* after its end PETSc has given back what its objects use */
  if (!s || PetscFinalized(&ended) || ended) return;
  KSPDestroy(&s->solver);
  MatDestroy(&s->matrix);
  VecDestroy(&s->rhs);
  VecDestroy(&s->answer);
  VecDestroy(&s->residual);
  VecDestroy(&s->correction);
  PetscOptionsDestroy(&s->options);
  PetscFree(s);
}

/* A matrix from its owned rows, sorted, each with its diagonal; symmetry 0 none, 1 symmetric, 2 positive definite. */
int zp_create(const void *comm, int64_t rows, const int64_t *starts, const int64_t *columns, const double *values,
              int symmetry, int block, const char *options, zp_solver **out)
{
  zp_solver *s = NULL;
  PetscErrorCode code = PetscNew(&s);
  first_message[0] = 0;
  *out = NULL;
  if (code) return (int)code;
  s->norm = -1.0;
  code = create(s, *(const MPI_Comm *)comm, rows, starts, columns, values, symmetry, block, options);
  if (!code && !(code = PetscOptionsPush(s->options))) {
    code = make_solver(s);
    PetscOptionsPop();
  }
  if (code) zp_destroy(s);
  else *out = s;
  return (int)code;
}

/* Whether column and row numbers up to `largest` fit PETSc's integers. */
int zp_fits(int64_t largest) { return largest < (int64_t)PETSC_MAX_INT; }

/* New values on the same pattern. */
int zp_update(zp_solver *s, const double *values)
{
  first_message[0] = 0;
  s->norm = -1.0;
  return (int)MatUpdateMPIAIJWithArray(s->matrix, values);
}

static PetscErrorCode near_null_space(zp_solver *s, int count, int64_t rows, const double *modes)
{
  Vec vectors[6];
  MatNullSpace space;
  PetscInt kept = 0;
  PetscFunctionBegin;
  for (int mode = 0; mode < count && mode < 6; mode++) {
    PetscScalar *entries;
    PetscReal size, rest;
    PetscCall(VecDuplicate(s->rhs, &vectors[kept]));
    PetscCall(VecGetArray(vectors[kept], &entries));
    memcpy(entries, modes + mode * rows, (size_t)rows * sizeof(double));
    PetscCall(VecRestoreArray(vectors[kept], &entries));
    PetscCall(VecNorm(vectors[kept], NORM_2, &size));
    for (PetscInt other = 0; other < kept; other++) {
      PetscScalar product;
      PetscCall(VecDot(vectors[kept], vectors[other], &product));
      PetscCall(VecAXPY(vectors[kept], -product, vectors[other]));
    }
    PetscCall(VecNormalize(vectors[kept], &rest));
    if (rest > 1e-10 * size) kept++;
    else PetscCall(VecDestroy(&vectors[kept]));
  }
  PetscCall(MatNullSpaceCreate(PetscObjectComm((PetscObject)s->matrix), PETSC_FALSE, kept, vectors, &space));
  PetscCall(MatSetNearNullSpace(s->matrix, space));
  PetscCall(MatNullSpaceDestroy(&space));
  for (PetscInt at = 0; at < kept; at++) PetscCall(VecDestroy(&vectors[at]));
  PetscFunctionReturn(0);
}

/* Vectors the matrix nearly maps to zero, one after another, each with the owned entries. */
int zp_near_null_space(zp_solver *s, int count, int64_t rows, const double *modes)
{
  first_message[0] = 0;
  return (int)near_null_space(s, count, rows, modes);
}

/* What MUMPS says of its factors, where it made them. */
static PetscErrorCode look_at_factors(zp_solver *s, zp_report *report)
{
  PC pc;
  PetscBool lu, cholesky;
  MatSolverType package = NULL;
  PetscFunctionBegin;
  report->null_pivots = report->factor_error = report->factor_detail = 0;
  PetscCall(KSPGetPC(s->solver, &pc));
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCLU, &lu));
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCCHOLESKY, &cholesky));
  if (!lu && !cholesky) PetscFunctionReturn(0);
  PetscCall(PCFactorGetMatSolverType(pc, &package));
#if defined(PETSC_HAVE_MUMPS)
  if (package && !strcmp(package, MATSOLVERMUMPS)) {
    Mat factors;
    PetscInt value;
    PetscCall(PCFactorGetMatrix(pc, &factors));
    PetscCall(MatMumpsGetInfog(factors, 1, &value));
    report->factor_error = value;
    PetscCall(MatMumpsGetInfog(factors, 2, &value));
    report->factor_detail = value;
    PetscCall(MatMumpsGetInfog(factors, 28, &value));
    report->null_pivots = value;
  }
#endif
  PetscFunctionReturn(0);
}

/* Errors of MUMPS that more memory mends. */
static int lacks_memory(int64_t error) { return error == -8 || error == -9 || error == -14 || error == -15 || error == -20; }

static PetscErrorCode set_up(zp_solver *s, zp_report *report)
{
  static const char *const more[] = {"60", "150", "400"};
  PC pc;
  PCFailedReason failed;
  PetscFunctionBegin;
  for (int attempt = 0;; attempt++) {
    PetscCall(KSPSetUp(s->solver));
    PetscCall(KSPGetPC(s->solver, &pc));
    PetscCall(PCGetFailedReason(pc, &failed));
    report->pc_failed = failed != PC_NOERROR;
    PetscCall(look_at_factors(s, report));
    if (!report->pc_failed || !lacks_memory(report->factor_error) || attempt == 3) break;
    PetscCall(PetscOptionsSetValue(s->options, "-mat_mumps_icntl_14", more[attempt]));
    PetscCall(KSPDestroy(&s->solver));
    PetscCall(make_solver(s));
  }
  PetscFunctionReturn(0);
}

/* residual = rhs - matrix answer */
static PetscErrorCode measure(zp_solver *s, zp_report *report)
{
  PetscReal norm;
  PetscFunctionBegin;
  PetscCall(MatMult(s->matrix, s->answer, s->residual));
  PetscCall(VecAYPX(s->residual, -1.0, s->rhs));
  PetscCall(VecNorm(s->residual, NORM_2, &norm));
  report->residual_norm = norm;
  PetscFunctionReturn(0);
}

static PetscErrorCode solve(zp_solver *s, int64_t rows, const double *rhs, double *answer, int refinements, zp_report *report)
{
  PetscLogDouble begin, middle, end;
  PetscScalar *entries;
  const PetscScalar *found;
  PetscReal norm;
  PetscInt iterations;
  KSPConvergedReason reason;
  PetscFunctionBegin;
  PetscCall(PetscTime(&begin));
  PetscCall(VecGetArrayWrite(s->rhs, &entries));
  memcpy(entries, rhs, (size_t)rows * sizeof(double));
  PetscCall(VecRestoreArrayWrite(s->rhs, &entries));
  PetscCall(VecNorm(s->rhs, NORM_2, &norm));
  report->rhs_norm = norm;
  if (s->norm < 0.0) {
    PetscCall(MatNorm(s->matrix, NORM_FROBENIUS, &norm));
    s->norm = norm;
  }
  report->matrix_norm = s->norm;
  if (PetscIsInfOrNanReal(report->rhs_norm) || PetscIsInfOrNanReal(report->matrix_norm)) PetscFunctionReturn(0);
  PetscCall(set_up(s, report));
  PetscCall(PetscTime(&middle));
  report->seconds_setup = middle - begin;
  if (report->pc_failed) PetscFunctionReturn(0);
  PetscCall(KSPSolve(s->solver, s->rhs, s->answer));
  PetscCall(KSPGetConvergedReason(s->solver, &reason));
  PetscCall(KSPGetIterationNumber(s->solver, &iterations));
  report->reason = (int)reason;
  report->iterations = iterations;
  PetscCall(measure(s, report));
  for (int step = 0; step < refinements && reason > 0 && report->residual_norm > 1e-11 * report->rhs_norm; step++) {
    const double before = report->residual_norm;
    PetscCall(KSPSolve(s->solver, s->residual, s->correction));
    PetscCall(VecAXPY(s->answer, 1.0, s->correction));
    PetscCall(measure(s, report));
    report->refinements++;
    if (!(report->residual_norm < before)) {
      PetscCall(VecAXPY(s->answer, -1.0, s->correction));
      PetscCall(measure(s, report));
      break;
    }
    if (report->residual_norm > 0.5 * before) break;
  }
  PetscCall(VecNorm(s->answer, NORM_2, &norm));
  report->answer_norm = norm;
  PetscCall(VecGetArrayRead(s->answer, &found));
  memcpy(answer, found, (size_t)rows * sizeof(double));
  PetscCall(VecRestoreArrayRead(s->answer, &found));
  PetscCall(PetscTime(&end));
  report->seconds_solve = end - middle;
  PetscFunctionReturn(0);
}

/* The answer to one right-hand side; `residual` receives rhs - matrix answer. */
int zp_solve(zp_solver *s, int64_t rows, const double *rhs, double *answer, double *residual, int refinements,
             zp_report *report)
{
  const PetscScalar *found;
  PetscErrorCode code;
  memset(report, 0, sizeof *report);
  first_message[0] = 0;
  code = PetscOptionsPush(s->options);
  if (code) return (int)code;
  code = solve(s, rows, rhs, answer, refinements, report);
  PetscOptionsPop();
  if (!code && residual && !(code = VecGetArrayRead(s->residual, &found))) {
    memcpy(residual, found, (size_t)rows * sizeof(double));
    code = VecRestoreArrayRead(s->residual, &found);
  }
  return (int)code;
}

/* The word PETSc has for a reason to stop. */
const char *zp_reason(int reason) { return KSPConvergedReasons[reason]; }

/* Options that nothing has read, in one line of at most `size` characters. */
int zp_unread_options(zp_solver *s, char *text, int size)
{
  PetscInt count = 0;
  char **names = NULL, **values = NULL;
  PetscErrorCode code = PetscOptionsLeftGet(s->options, &count, &names, &values);
  text[0] = 0;
  if (code) return (int)code;
  for (PetscInt at = 0; at < count; at++) {
    const size_t used = strlen(text);
    snprintf(text + used, (size_t)size - used, "%s-%s", at ? " " : "", names[at]);
  }
  return (int)PetscOptionsLeftRestore(s->options, &count, &names, &values);
}
