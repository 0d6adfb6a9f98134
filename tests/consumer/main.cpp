#include <cstdio>

#include "mesh/mandrel/load_mandrel.h"
#include "pipeline/load_inputs.h"
#include "pipeline/wind.h"
#include "report/report.h"

// consumer MANDREL MACHINE: program and summary on stdout; nothing is written.
int main(int /*count*/, char** arguments) {
    const meshwind::Machine machine = meshwind::load_machine(arguments[2]);
    const meshwind::Job job;
    const meshwind::Run run = meshwind::wind(
        meshwind::load_mandrel(arguments[1], meshwind::mandrel_options(job)), machine, job);
    std::puts(run.layers.front().programs.front().text.c_str());
    std::puts(meshwind::report_text(run).c_str());
    return run.passed() ? 0 : 1;
}
