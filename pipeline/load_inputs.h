/// Loads machine and job from their files, with the files that they name.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "machines/machine.h"
#include "pipeline/job/job.h"
#include "pipeline/verify_text.h"
#include "pipeline/wind.h"

namespace meshwind {

/// A machine with the triangles of its envelope and bodies.
/// \throws IoError io.cannot_read; InputError as read_machine() and read_triangles()
[[nodiscard]] Machine load_machine(const std::filesystem::path& file);

/// A job with the landing points of its imported layers. \param file empty: settings alone
/// \param base values of keys that it omits \throws IoError io.cannot_read; InputError as
/// read_job()
[[nodiscard]] Job load_job(const std::filesystem::path& file,
                           std::span<const JobSetting> settings = {}, const Job& base = {});

/// The same from a text. \param name for messages \param folder where imported layers' files are
[[nodiscard]] Job job_of_text(std::string_view text, const std::string& name,
                              const std::filesystem::path& folder,
                              std::span<const JobSetting> settings = {}, const Job& base = {});

/// A material or process: a file with keys of a job, for `base`. \param base profiles before it
/// \throws IoError io.cannot_read, with a list of those that come with meshwind; InputError as
/// read_job()
[[nodiscard]] Job load_profile(const std::filesystem::path& file, const Job& base = {});

/// Reads a mandrel's file as a job asks for it, for wind(). \param digest receives the file's
/// digest for the programs' heads; must outlive the reader
[[nodiscard]] MandrelOf mandrel_reader(std::filesystem::path file, double unit_mm,
                                       std::string& digest);

/// The mandrel that a program's head names: beside the program, in the folder above it, or where
/// find_input() finds it; where the head has a digest, the first file that has the same.
/// \param program its file \param name of the mandrel's file \param digest empty: any
/// \throws InputError origin.not_named, origin.no_file, origin.other_mandrel
[[nodiscard]] std::filesystem::path mandrel_named_by(const std::filesystem::path& program,
                                                     const std::string& name,
                                                     const std::string& digest);

/// Its machine file, searched for in the same places. \throws InputError origin.not_named,
/// origin.no_file
[[nodiscard]] std::filesystem::path machine_named_by(const std::filesystem::path& program,
                                                     const std::string& name);

/// A table of a plan's folder for one of its programs, "path-2.csv" for "program-2.ngc" where there
/// is one. \param name "path" or "motion" \throws IoError io.cannot_read
[[nodiscard]] NamedText plan_table(const std::filesystem::path& plan,
                                   const std::filesystem::path& program, const std::string& name);

/// The landing points of a file.
/// \throws IoError io.cannot_read
[[nodiscard]] LandingText read_landing_points(const std::filesystem::path& file);

}  // namespace meshwind
