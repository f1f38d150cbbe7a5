/* Stopping by SIGINT or SIGTERM. The program goes through these steps, in this order: */
#ifndef PPM_CLI_SIGNALS_H
#define PPM_CLI_SIGNALS_H

#include <stdbool.h>

#include "ppm/render.h"

/* Nothing to save yet: a signal ends the program with status 130. */
void signals_install(void);
/* A signal asks for a stop; the first pass is finished all the same, so that there is a picture.
 * Here and in the next step a second signal ends the program with status 130. */
void signals_enter_first_pass(ppm_render *render);
/* A signal asks for a stop and cancels the running pass. */
void signals_enter_passes(ppm_render *render);
/* The render may be destroyed, and another may follow: a signal ends the program with status 130;
 * the pictures before are complete. */
void signals_leave_picture(void);
/* The last render may be destroyed; signals are ignored for the little that is left. */
void signals_leave_render(void);

bool signals_stop_requested(void);

#endif
