/* The tables behind ppmi_aim: seen by its two files only. */
#ifndef PPMI_LIGHT_AIM_TABLES_H
#define PPMI_LIGHT_AIM_TABLES_H

#include "light/aim.h"
#include "light/tables.h"

/* All tables are sums of probabilities up to an entry, and one more at the end. */
struct ppmi_aim {
    ppm_context *context;
    const ppmi_lights *lights;
    ppmi_target targets[PPMI_AIM_TARGETS]; /* from the smallest on */
    uint32_t target_count;
    double parts[PPMI_AIM_TARGETS + 2];
    uint32_t group_count;  /* of emitters that follow each other: a part chooses among groups, */
    uint32_t *group_first; /* of each, and the end, the first emitter */
    double *groups;        /* of each part */
    double *powers;        /* of emitters: within its group each is chosen by power */
    double *sky_rows;      /* of the environment's image; or NULL */
    double *sky_columns;   /* of each row */
    double *solid_angles;  /* of the scene's punctual lights */
};

/* Fills in groups and their shares. False when memory is out. */
bool ppmi_aim_fill_groups(ppmi_aim *aim);

#endif
