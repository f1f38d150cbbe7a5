/* Progress is known at the end of each pass. Time left comes from the mean pass so far. */
#include "progress.h"

#include <math.h>
#include <stdio.h>

static const double PLAIN_LINE_EVERY_S = 10.0;

void progress_init(cli_progress *progress, uint64_t pass_limit, double seconds_limit)
{
    *progress = (cli_progress){.pass_limit = pass_limit,
                               .seconds_limit = seconds_limit,
                               .next_pass_shown = 1,
                               .label = ""};
}

void progress_set_sequence(cli_progress *progress, const char *label, uint64_t pictures_after,
                           double seconds_per_picture)
{
    progress->label = label;
    progress->pictures_after = pictures_after;
    progress->seconds_per_picture = seconds_per_picture;
    progress->next_pass_shown = UINT64_MAX;
}

bool progress_is_done(const cli_progress *progress, uint64_t passes, double elapsed)
{
    if (passes == 0) return false;
    if (progress->pass_limit > 0 && passes >= progress->pass_limit) return true;
    const double half_pass = 0.5 * elapsed / (double)passes;
    return progress->seconds_limit > 0.0 && elapsed + half_pass >= progress->seconds_limit;
}

static double share_done(const cli_progress *progress, uint64_t passes, double elapsed)
{
    double share = 0.0;
    if (progress->pass_limit > 0) share = (double)passes / (double)progress->pass_limit;
    if (progress->seconds_limit > 0.0) share = fmax(share, elapsed / progress->seconds_limit);
    return fmin(share, 1.0);
}

static double seconds_left(const cli_progress *progress, uint64_t passes, double elapsed)
{
    double left = INFINITY;
    if (progress->pass_limit > 0) {
        const double passes_left = (double)progress->pass_limit - (double)passes;
        left = passes_left * elapsed / (double)passes;
    }
    if (progress->seconds_limit > 0.0) left = fmin(left, progress->seconds_limit - elapsed);
    return fmax(left, 0.0);
}

/* Pictures to come take as long as those before did, or as this one seems to. */
static double seconds_left_of_all(const cli_progress *progress, uint64_t passes, double elapsed)
{
    const double left = seconds_left(progress, passes, elapsed);
    const double each =
        progress->seconds_per_picture > 0.0 ? progress->seconds_per_picture : elapsed + left;
    return left + (double)progress->pictures_after * each;
}

const char *progress_duration(double seconds, char *buffer, size_t buffer_size)
{
    const unsigned long long whole = (unsigned long long)ceil(seconds);
    if (whole < 3600) {
        snprintf(buffer, buffer_size, "%llu:%02llu", whole / 60, whole % 60);
    } else {
        snprintf(buffer, buffer_size, "%llu:%02llu:%02llu", whole / 3600, whole / 60 % 60,
                 whole % 60);
    }
    return buffer;
}

/* A path tracer emits no photons; its rays are counted instead. */
static void format_rate(const ppm_render_stats *stats, char *buffer, size_t buffer_size)
{
    const bool has_photons = stats->photons_emitted > 0;
    const double count = (double)(has_photons ? stats->photons_emitted : stats->rays);
    const double rate = stats->seconds_render > 0.0 ? count / stats->seconds_render : 0.0;
    const bool is_large = rate >= 1e6;
    snprintf(buffer, buffer_size, "%.*f %s %s/s", is_large ? 2 : 0, rate / (is_large ? 1e6 : 1e3),
             is_large ? "M" : "k", has_photons ? "photons" : "rays");
}

const char *progress_line(const cli_progress *progress, const ppm_render_stats *stats,
                          double elapsed, char *buffer, size_t buffer_size)
{
    char limit[32] = "", left[32], rate[48];
    if (progress->pass_limit > 0) {
        snprintf(limit, sizeof limit, "/%llu", (unsigned long long)progress->pass_limit);
    }
    progress_duration(seconds_left_of_all(progress, stats->passes, elapsed), left, sizeof left);
    format_rate(stats, rate, sizeof rate);
    snprintf(buffer, buffer_size, "%spass %llu%s  %3.0f%%  %s  %s left", progress->label,
             (unsigned long long)stats->passes, limit,
             floor(100.0 * share_done(progress, stats->passes, elapsed)), rate, left);
    return buffer;
}

void progress_show(cli_progress *progress, cli_console *console, const ppm_render_stats *stats,
                   double elapsed)
{
    const bool is_milestone = stats->passes >= progress->next_pass_shown;
    const bool is_due = elapsed - progress->seconds_shown >= PLAIN_LINE_EVERY_S;
    if (!console->is_terminal && !is_milestone && !is_due) return;
    while (progress->next_pass_shown <= stats->passes)
        progress->next_pass_shown *= 2;
    progress->seconds_shown = elapsed;
    char line[320];
    console_progress(console, progress_line(progress, stats, elapsed, line, sizeof line));
}
