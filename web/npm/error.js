// SPDX-License-Identifier: BSD-2-Clause
// Failures, with the library's codes and messages.

const CODES = ['OK', 'USAGE', 'MEMORY', 'IO', 'DATA', 'TRUNCATED', 'UNSUPPORTED', 'LIMIT', 'FPENV', 'INTERNAL']; // adcgs/status.h

export class AdcgsError extends Error {
    constructor(code, message) {
        super(message);
        this.name = 'AdcgsError';
        this.code = code;
    }

    /** The failure that an engine has just reported. */
    static from(engine, status) {
        return new AdcgsError(CODES[-status] || 'INTERNAL', engine.text(engine.call.page_error()));
    }
}
