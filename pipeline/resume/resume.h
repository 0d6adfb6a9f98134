/// Resumes a stopped program: its rest as a program of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/run_context.h"
#include "pipeline/setup.h"
#include "pipeline/verify_text.h"
#include "postproc/motion/block.h"
#include "postproc/nc/made_from.h"
#include "postproc/verify/laydown.h"
#include "postproc/verify/verify.h"

namespace meshwind {

/// A program and the fibre it lays.
struct LaidProgram {
    std::string file;  ///< name used in messages
    std::optional<MadeFrom> made_from;
    Setup setup;
    BlockList blocks;
    LaidPath laid;
};

/// The rest of a program.
struct ResumedProgram {
    std::size_t block = 0;  ///< the last one that has been run, from 1
    std::int32_t line = 0;  ///< of it
    std::string text;
    BlockList blocks;  ///< as read from the text; block 0 is the start
    Verification
        verification;      ///< of these: wound again, compared with the fibre of the whole program
    double laid_mm = 0.0;  ///< fibre that lies already

    [[nodiscard]] bool passed() const;
};

/// Reads a program and lays its fibre. \throws InputError as verify_text()
[[nodiscard]] LaidProgram lay_program(Setup setup, const VerifyInputs& inputs,
                                      const RunContext& context = {});

/// The block that a line of the text runs. \throws InputError resume.line for none or several, with
/// these
[[nodiscard]] std::size_t block_of_line(const LaidProgram& program, std::int32_t line);

/// The program from the end of `block` on: a head that brings every axis there, a stop to tie on
/// the fibre at its place, and the blocks behind it. Rotary axes without end stops begin within
/// half a turn of zero, so that nothing unwinds on the way there. The first blocks are slower where
/// the machine could not reach their speeds from rest. \param block the last one that has been run
/// \throws InputError resume.block where it is the last of all, or there is none; resume.in_the_air
/// where the fibre lies on a pin or hangs over a hollow, with the nearest block before it where it
/// does not; resume.not_followed where it cannot be followed so far
[[nodiscard]] ResumedProgram resume(const LaidProgram& program, std::size_t block,
                                    const RunContext& context = {});

}  // namespace meshwind
