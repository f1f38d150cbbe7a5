/* What the program shows on standard output instead of rendering. */
#ifndef PPM_CLI_INFO_H
#define PPM_CLI_INFO_H

#include "ppm/ppm.h"

/* All return EXIT_DONE, or EXIT_OUTPUT when standard output does not take the text. */
int info_print_help(void);
int info_print_version(void);
int info_print_views(const ppm_color *color);

#endif
