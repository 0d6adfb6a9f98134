/// A program that stopped on its way: what is left of it, as a program of its own.
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

/// A program and what it lays.
struct LaidProgram {
    std::string file;  ///< name used in messages
    std::optional<MadeFrom> made_from;
    Setup setup;
    BlockList blocks;
    LaidPath laid;
};

/// What is left of a program.
struct ResumedProgram {
    std::size_t block = 0;  ///< the last one that has been run, from 1
    std::int32_t line = 0;  ///< of it
    std::string text;
    BlockList blocks;           ///< as read from the text; block 0 is the start
    Verification verification;  ///< of these: wound again, and against what the whole lays
    double laid_mm = 0.0;       ///< fibre that lies already

    [[nodiscard]] bool passed() const;
};

/// Reads a program and lays its fibre. \throws InputError as verify_text()
[[nodiscard]] LaidProgram lay_program(Setup setup, const VerifyInputs& inputs,
                                      const RunContext& context = {});

/// The block that is run in a line of the text. \throws InputError resume.line where none or
/// several are, with these
[[nodiscard]] std::size_t block_of_line(const LaidProgram& program, std::int32_t line);

/// The program from the end of `block` on: a head that brings every axis there, a stop for the tie
/// at the place where the fibre lies, and the blocks behind it. Rotary axes without end stops begin
/// within half a turn of zero, so that nothing unwinds on the way there; the first blocks are
/// slower where the machine could not get from rest to their speeds. \param block the last one that
/// has been run \throws InputError resume.block where it is the last of all, or there is none;
/// resume.in_the_air where the fibre lies on a pin or hangs over a hollow, with the nearest block
/// before it where it does not; resume.not_followed where it cannot be followed so far
[[nodiscard]] ResumedProgram resume(const LaidProgram& program, std::size_t block,
                                    const RunContext& context = {});

}  // namespace meshwind
