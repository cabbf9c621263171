// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where is what was installed with this program?
///
///                build tree                        installation
///   the tool     build/…/bin/talisman              PREFIX/bin/talisman
///   importer     build/…/bin/talisman_import       PREFIX/libexec/talisman/talisman_import
///   pictures     build/…/bin/talisman_pictures.so  PREFIX/lib/talisman/talisman_pictures.so
///   live view    build/…/bin/talisman_view.so      PREFIX/lib/talisman/talisman_view.so
///   sequences    sequences/ of the source tree     PREFIX/share/talisman/sequences/
///
/// Both kinds of tree can be moved: everything is looked for in the folders above the file from which this code
/// was loaded, the nearest first, and then in the folder that the environment variable TALISMAN_HOME names, a
/// source tree or a PREFIX.

#include <string>

namespace talisman::sequences {

/// Folder of the file from which this code was loaded, without a slash at its end: that of the running program,
/// or of the shared module (a Python extension, say) that this code is linked into.
std::string program_folder();

/// The program that reads models (import/model_import.h); where it should be if it is not there.
std::string importer_program();

/// A module of the program, "talisman_pictures.so" (files/picture_codec.h), "talisman_view.so" (view/http_service.h); where
/// it should be if it is not there.
std::string program_module(const std::string& file);

/// Loads a module, since what it links would make every command start later, and returns a symbol of it, which stays for
/// as long as the program lasts. Throws OutputError, "WHAT: why".
void* program_symbol(const std::string& module, const char* symbol, const std::string& what_cannot_be_done);

/// The folder whose folder sequences/ has the sequences that come with the program: the root of the source tree,
/// or PREFIX/share/talisman. Empty when there is none, because the program was moved away from them.
std::string data_folder();

}  // namespace talisman::sequences
