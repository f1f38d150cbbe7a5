/* The numbers, for people and for programs. */
#ifndef PPM_COMPARE_REPORT_H
#define PPM_COMPARE_REPORT_H

#include <stdbool.h>

#include "compare/flip.h"
#include "compare/metrics.h"
#include "compare/options.h"
#include "compare/pair.h"

/* FLIP of the whole picture. */
typedef struct flip_summary {
    bool is_hdr;
    double pixels_per_degree;
    ppmi_compare_exposures exposures; /* HDR */
    double exposure_ev;               /* LDR */
    double mean, largest;             /* of the pixels that are not broken */
} flip_summary;

typedef struct comparison {
    ppmi_compare_pair pair;
    ppmi_compare_metrics metrics;
    flip_summary flip;
} comparison;

/* Prints to standard output. Returns EXIT_DONE, EXIT_OUTPUT or EXIT_RESOURCES. */
int report_print(const comparison *result, const compare_options *options);

/* Says on standard error which limits are passed. Returns EXIT_DONE or EXIT_ABOVE. */
int report_check_limits(const comparison *result, const compare_options *options);

/* Whether all that was printed has arrived. Returns EXIT_DONE or EXIT_OUTPUT. */
int report_finish(void);

#endif
